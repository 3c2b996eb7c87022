#include "scenes/io/read_bytes.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "common/errors.h"

namespace flowskin::scenes {
namespace {

namespace fs = std::filesystem;

/// What an input is instead of a regular file, in words.
std::string kind_in_words(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "this is a folder, a file was expected";
    case fs::file_type::fifo:
      return "this is a pipe; inputs are read more than once, so process substitution <(...) cannot be one: save it to "
             "a file";
    case fs::file_type::character:
    case fs::file_type::block:
      return "this is a device";
    case fs::file_type::socket:
      return "this is a socket";
    default:
      return "its kind is unknown";
  }
}

double memory_of_machine() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

using Stream = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Stream opened(const fs::path& file) {
  Stream stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) throw InputError(file.string() + ": cannot be opened: " + std::generic_category().message(errno));
  return stream;
}

}  // namespace

void require_regular_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  const std::string name = file.string();
  if (status.type() == fs::file_type::not_found) throw InputError(name + ": there is no such file");
  if (status.type() == fs::file_type::none) throw InputError(name + ": cannot be opened: " + error.message());
  if (status.type() != fs::file_type::regular)
    throw InputError(name + ": is not a regular file: " + kind_in_words(status.type()));
}

std::string read_bytes(const fs::path& file, std::uintmax_t most) {
  require_regular_file(file);
  const std::string name = file.string();
  std::error_code ignored;
  // The size is only a first guess: files under /proc have none.
  const std::uintmax_t size = fs::file_size(file, ignored);
  if (!ignored && (size > most || static_cast<double>(size) > memory_of_machine()))
    throw InputError(fmt::format("{}: the file is too large: {:.4g} MB, more than {}", name,
                                 static_cast<double>(size) / 1e6,
                                 size > most ? fmt::format("the {:.4g} MB allowed", static_cast<double>(most) / 1e6)
                                             : "the memory of this machine"));
  const Stream stream = opened(file);
  std::string bytes;
  if (!ignored) bytes.reserve(static_cast<std::size_t>(size) + 1);
  std::array<char, 1 << 16> block{};
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), stream.get())) {
    bytes.append(block.data(), count);
    if (bytes.size() > most) throw InputError(name + ": the file is too large, or grows while it is read");
  }
  if (std::ferror(stream.get()) != 0)
    throw InputError(name + ": cannot be read: " + std::generic_category().message(errno));
  return bytes;
}

std::string first_bytes(const fs::path& file, std::size_t count) {
  require_regular_file(file);
  const Stream stream = opened(file);
  std::string bytes(count, '\0');
  bytes.resize(std::fread(bytes.data(), 1, count, stream.get()));
  return bytes;
}

}  // namespace flowskin::scenes
