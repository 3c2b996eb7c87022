#include "scenes/io/read_bytes.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "common/errors.h"

namespace flowskin::scenes {

std::string read_bytes(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) throw InputError(name + ": there is no such file");
  if (std::filesystem::is_directory(file, ignored)) throw InputError(name + ": this is a folder, a file was expected");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(name.c_str(), "rb"), &std::fclose);
  if (!stream) throw InputError(name + ": cannot be opened: " + std::generic_category().message(errno));
  std::string bytes;
  // The size is only a first guess: pipes and files under /proc have none.
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  if (!ignored) bytes.reserve(static_cast<std::size_t>(size) + 1);
  std::array<char, 1 << 16> block{};
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), stream.get()))
    bytes.append(block.data(), count);
  if (std::ferror(stream.get()) != 0)
    throw InputError(name + ": cannot be read: " + std::generic_category().message(errno));
  return bytes;
}

}  // namespace flowskin::scenes
