#include "common/errors.h"

#include <filesystem>

namespace flowskin {

std::string plain_message(const std::exception& error) {
  const auto* of_files = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  if (of_files == nullptr) return error.what();
  const std::string place = of_files->path1().string();
  return (place.empty() ? "the current folder" : place) + ": " + of_files->code().message();
}

}  // namespace flowskin
