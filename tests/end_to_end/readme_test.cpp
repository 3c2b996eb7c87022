// README.md and the pages of docs/: what they show is what the tests compile, and their links lead somewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>
#include <sstream>

#include "end_to_end/program.h"

namespace flowskin {
namespace {

namespace fs = std::filesystem;

const fs::path source_folder = FLOWSKIN_SOURCE_DIR;

// README.md and CHANGELOG.md, and all pages of docs/.
std::vector<fs::path> pages() {
  std::vector<fs::path> found = {source_folder / "README.md", source_folder / "CHANGELOG.md"};
  for (const auto& entry : fs::directory_iterator(source_folder / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  std::sort(found.begin() + 2, found.end());
  return found;
}

// A page cut into what stands in ``` blocks, each with the language in its first line, and the rest.
struct Page {
  std::vector<std::string> blocks;
  std::vector<std::string> lines;
};

Page read_page(const fs::path& file) {
  Page page;
  std::istringstream text(end_to_end::bytes(file));
  bool in_block = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      in_block = !in_block;
      if (in_block) page.blocks.push_back(line.substr(3) + "\n");
    } else if (in_block) {
      page.blocks.back() += line + "\n";
    } else {
      page.lines.push_back(line);
    }
  }
  EXPECT_FALSE(in_block) << file << ": a ``` block is not closed";
  return page;
}

// The name that GitHub gives a heading: small letters, digits, - and _ stay, spaces become -. Letters beyond ASCII stay
// too, but for the dashes; links to headings with other such characters are not used here.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80) anchor += static_cast<char>(std::tolower(byte));
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

std::set<std::string> anchors_of(const Page& page) {
  std::set<std::string> anchors;
  for (const std::string& line : page.lines) {
    if (!line.starts_with("#")) continue;
    const std::string anchor = anchor_of(line.substr(line.find_first_not_of("# ")));
    std::string name = anchor;
    for (int twin = 1; !anchors.insert(name).second; ++twin) name = anchor + "-" + std::to_string(twin);
  }
  return anchors;
}

// Targets of the links and pictures of a page. `code` in a line shows no link, and neither does a link over two lines
// miss: text and target stand next to each other.
std::vector<std::string> links_of(const Page& page) {
  static const std::regex code("`[^`]*`"), link(R"(\]\(([^)\s]+)\))");
  std::vector<std::string> targets;
  for (const std::string& line : page.lines) {
    const std::string text = std::regex_replace(line, code, "");
    for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found)
      targets.push_back((*found)[1]);
  }
  return targets;
}

// What is wrong with a link; empty: nothing.
std::string fault_of(const fs::path& from, const std::string& link) {
  if (link.starts_with("https://") || link.starts_with("http://")) return "";
  const std::size_t hash = link.find('#');
  const std::string name = link.substr(0, hash);
  const fs::path target = name.empty() ? from : from.parent_path() / name;
  if (!fs::exists(target)) return "there is no such file";
  if (hash == std::string::npos) return "";
  if (target.extension() != ".md") return "only pages have headings";
  return anchors_of(read_page(target)).count(link.substr(hash + 1)) > 0 ? "" : "there is no such heading";
}

TEST(Readme, TheLibraryPageShowsTheExampleThatIsCompiled) {
  const std::string page = end_to_end::bytes(source_folder / "docs/library.md");
  const std::string example = end_to_end::bytes(source_folder / "tests/examples/library_example.cpp");
  EXPECT_NE(page.find("```cpp\n" + example + "```\n"), std::string::npos)
      << "docs/library.md and tests/examples/library_example.cpp differ";
}

TEST(Readme, NoPageShowsCodeThatIsNotCompiled) {
  const std::string example = end_to_end::bytes(source_folder / "tests/examples/library_example.cpp");
  int shown = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& block : read_page(page).blocks) {
      if (!block.starts_with("cpp\n")) continue;
      ++shown;
      EXPECT_EQ(block, "cpp\n" + example) << page << " shows C++ that no test compiles";
    }
  }
  EXPECT_GE(shown, 1);
}

TEST(Readme, IsALandingPage) {
  const Page readme = read_page(source_folder / "README.md");
  const std::string text = end_to_end::bytes(source_folder / "README.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 120) << "what is longer belongs to docs/";
  const std::vector<std::string> links = links_of(readme);
  EXPECT_EQ(std::count(links.begin(), links.end(), "docs/library.md") > 0, true) << "the example is not to be found";
}

TEST(Readme, EveryLinkLeadsSomewhere) {
  int links = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& link : links_of(read_page(page))) {
      ++links;
      const std::string fault = fault_of(page, link);
      EXPECT_TRUE(fault.empty()) << page.filename() << " links to " << link << ": " << fault;
    }
  }
  EXPECT_GT(links, 80);
}

// Files and folders of the repository that a page names as `code`.
std::vector<std::string> paths_named_in(const Page& page) {
  static const std::regex path(R"(`((?:common|sph|tracking|scenes|tools|tests|docs)/[A-Za-z0-9_./]*)`)");
  std::vector<std::string> paths;
  for (const std::string& line : page.lines)
    for (std::sregex_iterator found(line.begin(), line.end(), path), end; found != end; ++found)
      paths.push_back((*found)[1]);
  return paths;
}

TEST(Readme, FilesThatPagesNameExist) {
  int paths = 0;
  for (const fs::path& page : pages()) {
    if (page.filename() == "CHANGELOG.md") continue;  // tells of the past
    for (const std::string& path : paths_named_in(read_page(page))) {
      ++paths;
      EXPECT_TRUE(fs::exists(source_folder / path)) << page.filename() << " names " << path << ", which is not there";
    }
  }
  EXPECT_GT(paths, 40);
}

TEST(Readme, TheIndexNamesEveryPage) {
  const std::vector<std::string> links = links_of(read_page(source_folder / "docs/README.md"));
  for (const fs::path& page : pages()) {
    if (page.parent_path() != source_folder / "docs" || page.filename() == "README.md") continue;
    EXPECT_EQ(std::count(links.begin(), links.end(), page.filename().string()), 1)
        << "docs/README.md should name " << page.filename() << " once";
  }
}

// The check itself: these faults are found.
TEST(Readme, FaultyLinksAreNoticed) {
  const fs::path readme = source_folder / "README.md";
  EXPECT_EQ(fault_of(readme, "docs/scenes.md"), "");
  EXPECT_EQ(fault_of(readme, "docs/scenes.md#all-keys"), "");
  EXPECT_EQ(fault_of(readme, "#two-commands"), "");
  EXPECT_EQ(fault_of(readme, "docs/scenery.md"), "there is no such file");
  EXPECT_EQ(fault_of(readme, "docs/scenes.md#no-keys"), "there is no such heading");
  EXPECT_EQ(fault_of(readme, "#three-commands"), "there is no such heading");
  EXPECT_EQ(anchor_of("Fluid that fills its space: particle shifting"), "fluid-that-fills-its-space-particle-shifting");
  EXPECT_EQ(anchor_of("frames.csv"), "framescsv");
}

}  // namespace
}  // namespace flowskin
