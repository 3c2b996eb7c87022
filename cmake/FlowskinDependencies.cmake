# Finds every library the project uses; one that is missing stops the configuration with the name of its Debian package.

function(flowskin_missing what package)
  message(FATAL_ERROR "FlowSkin needs ${what}, which was not found.\n"
                      "On Debian: apt-get install ${package}   (tools/build installs everything by itself)")
endfunction()

macro(flowskin_find name package)
  find_package(${name} ${ARGN} QUIET)
  if(NOT ${name}_FOUND)
    flowskin_missing(${name} ${package})
  endif()
endmacro()

flowskin_find(OpenMP "g++ (or libomp-dev for clang)")
flowskin_find(Eigen3 libeigen3-dev)
flowskin_find(nanoflann libnanoflann-dev)
flowskin_find(tinyobjloader libtinyobjloader-dev)
flowskin_find(nlohmann_json nlohmann-json3-dev)
flowskin_find(fmt libfmt-dev)
flowskin_find(spdlog libspdlog-dev)
flowskin_find(embree libembree-dev 3)
flowskin_find(CLI11 libcli11-dev)
flowskin_find(ZLIB zlib1g-dev)

# stb has no CMake package on Debian, only headers.
find_path(FLOWSKIN_STB_INCLUDE_DIR stb_image_write.h PATH_SUFFIXES stb)
if(NOT FLOWSKIN_STB_INCLUDE_DIR)
  flowskin_missing("stb (stb_image.h and stb_image_write.h)" libstb-dev)
endif()
add_library(flowskin_stb INTERFACE)
target_include_directories(flowskin_stb SYSTEM INTERFACE ${FLOWSKIN_STB_INCLUDE_DIR})

# cairo (for the plots) has no CMake package either; it is asked for through pkg-config.
flowskin_find(PkgConfig pkg-config)
pkg_check_modules(FLOWSKIN_CAIRO QUIET IMPORTED_TARGET cairo>=1.16 cairo-svg cairo-png)
if(NOT FLOWSKIN_CAIRO_FOUND)
  flowskin_missing("cairo 1.16 or later, with SVG and PNG" libcairo2-dev)
endif()
add_library(flowskin_cairo INTERFACE)
target_link_libraries(flowskin_cairo INTERFACE PkgConfig::FLOWSKIN_CAIRO)

# LZ4 and HDF5, for particle files. Debian parts HDF5 by whether it is for one machine.
pkg_check_modules(FLOWSKIN_LZ4 QUIET IMPORTED_TARGET liblz4)
if(NOT FLOWSKIN_LZ4_FOUND)
  flowskin_missing("LZ4" liblz4-dev)
endif()
pkg_search_module(FLOWSKIN_HDF5 QUIET IMPORTED_TARGET hdf5-serial hdf5)
if(NOT FLOWSKIN_HDF5_FOUND)
  flowskin_missing("HDF5" libhdf5-dev)
endif()

if(FLOWSKIN_TESTS)
  flowskin_find(GTest "libgtest-dev libgmock-dev")
  if(NOT TARGET GTest::gmock)
    flowskin_missing("GoogleMock's matchers" libgmock-dev)
  endif()
  find_package(benchmark QUIET)
endif()
