// Walks over the tags of an XML text: as much of XML as VTK's files use.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flowskin::scenes {

/// A tag such as <Piece NumberOfPoints="8">; comments, declarations and text between tags are no tags.
struct XmlTag {
  std::string name;
  bool opens = false, closes = false;  ///< Both for <a/>.
  std::vector<std::pair<std::string, std::string>> attributes;
  std::size_t start = 0, end = 0;  ///< Offsets of its first character and of the one after its last.

  /// Value of an attribute, or nullptr; names are compared letter by letter.
  const std::string* find(std::string_view attribute) const;
};

class XmlScanner {
 public:
  /// `name` stands for the file in messages; both must outlive the scanner.
  XmlScanner(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  /// The next tag; false at the end of the text. @throws InputError naming the line, where a tag is not well formed.
  bool next(XmlTag& tag);
  /// Offset from which the next tag is looked for.
  std::size_t place() const { return at_; }
  /// @throws InputError with the line of a place in the text.
  [[noreturn]] void fail(std::size_t place, const std::string& message) const;

 private:
  void read_attribute(XmlTag& tag);

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

}  // namespace flowskin::scenes
