// Reads zip archives.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace flowskin::scenes {

/// Calls visit(name, content) for each file in the archive, in its order.
/// @param name stands for the archive in messages
/// @throws InputError where the archive is damaged, encrypted, or compressed by anything but deflate.
void for_each_in_zip(std::string_view bytes, const std::string& name,
                     const std::function<void(const std::string&, std::string_view)>& visit);

}  // namespace flowskin::scenes
