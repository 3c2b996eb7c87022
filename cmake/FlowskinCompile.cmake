# One interface target with the flags of every target of the project.

add_library(flowskin_compile INTERFACE)
target_include_directories(flowskin_compile INTERFACE ${CMAKE_SOURCE_DIR})
# No errno from sqrt and no trapping arithmetic: both would keep loops from being vectorised. Unlike -ffast-math these
# leave NaN, infinity and the order of sums alone, so results stay the same at any thread count.
target_compile_options(flowskin_compile INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # g++ 12 warns of std::string's own operator+ (GCC bug 105651).
  target_compile_options(flowskin_compile INTERFACE -Wno-restrict)
endif()
if(FLOWSKIN_NATIVE)
  target_compile_options(flowskin_compile INTERFACE -march=native)
  # The loops are written for vectors of eight floats. With AVX-512, g++ 12 warns of its own intrinsics (GCC bug 105593), and
  # results would differ between processors with it and those with AVX2 only.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(flowskin_compile INTERFACE -mno-avx512f)
  endif()
else()
  # Vectors of eight floats are handed over otherwise than with AVX; all code that does so is compiled here, alike.
  target_compile_options(flowskin_compile INTERFACE -Wno-psabi)
endif()
if(FLOWSKIN_WERROR)
  target_compile_options(flowskin_compile INTERFACE -Werror)
endif()
if(FLOWSKIN_SANITIZE)
  target_compile_options(flowskin_compile INTERFACE
    -fsanitize=${FLOWSKIN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(flowskin_compile INTERFACE -fsanitize=${FLOWSKIN_SANITIZE})
endif()
target_link_libraries(flowskin_compile INTERFACE OpenMP::OpenMP_CXX)
# Eigen's own threads and run-time alignment asserts stay out of our parallel loops.
target_compile_definitions(flowskin_compile INTERFACE EIGEN_DONT_PARALLELIZE)

# flowskin_library(<name>): the static library flowskin::<name> of every source file below the current folder.
function(flowskin_library name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp *.h)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  add_library(flowskin_${name} STATIC ${sources})
  add_library(flowskin::${name} ALIAS flowskin_${name})
  set_target_properties(flowskin_${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(flowskin_${name} PUBLIC flowskin_compile)
endfunction()

# flowskin_fuzzed(<target>): where fuzzers are built, libFuzzer sees which code of the target an input reaches.
function(flowskin_fuzzed target)
  if(FLOWSKIN_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()
