// Calling the built program and looking at what it wrote.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace flowskin::end_to_end {

struct Result {
  int status = -1;
  std::string output;  ///< standard output and standard error
};

/// Runs build/flowskin with these arguments.
Result run_flowskin(const std::vector<std::string>& arguments);
/// Runs build/flowskin, and sends it a signal, so many times, once `due` says so; it is asked all the time.
Result run_flowskin_until(const std::vector<std::string>& arguments, const std::function<bool()>& due, int signal,
                          int times = 1);
/// Runs a program of the path; status 127 where there is none.
Result run_program(const std::vector<std::string>& command);
bool have_program(const std::string& name);

/// An empty folder below the system's temporary one.
std::filesystem::path fresh_folder(const std::string& name);
/// A shipped scene's file name.
std::string scene(const std::string& name);
std::string bytes(const std::filesystem::path& file);
/// Names of all files below a folder, relative to it, ascending.
std::vector<std::string> files_below(const std::filesystem::path& folder);

/// The entries of the first video stream, comma separated, counted by decoding.
std::string ffprobe(const std::filesystem::path& file, const std::string& entries);

/// Mean absolute difference of the channels of two pictures, 0 to 255; infinity where their sizes differ.
double mean_pixel_difference(const std::filesystem::path& a, const std::filesystem::path& b);

/// A CSV file with a header.
class Table {
 public:
  explicit Table(const std::filesystem::path& file);
  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t rows() const { return cells_.size(); }
  double number(const std::string& column, std::size_t row) const;
  /// All cells of a column.
  std::vector<std::string> text(const std::string& column) const;

 private:
  std::size_t index(const std::string& column) const;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace flowskin::end_to_end
