#include "end_to_end/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "tools/textures/image.h"

namespace flowskin::end_to_end {

namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

Result run_program(const std::vector<std::string>& command) {
  std::string line;
  for (const std::string& word : command) line += quoted(word) + " ";
  Result result;
  FILE* pipe = popen((line + "2>&1 </dev/null").c_str(), "r");
  if (!pipe) throw std::runtime_error("popen failed");
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe))
    result.output.append(buffer.data(), count);
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

Result run_flowskin(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{FLOWSKIN_BINARY_DIR "/flowskin"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_program(command);
}

Result run_flowskin_until(const std::vector<std::string>& arguments, const std::function<bool()>& due, int signal,
                          int times) {
  const fs::path said = fs::temp_directory_path() / ("flowskin_said_" + std::to_string(getpid()));
  const pid_t child = fork();
  if (child == 0) {
    // A shell that runs the tests in the background has signals ignored.
    std::signal(SIGINT, SIG_DFL);
    const int file = open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    std::vector<char*> words;
    std::string program = FLOWSKIN_BINARY_DIR "/flowskin";
    words.push_back(program.data());
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execv(program.c_str(), words.data());
    _exit(127);
  }
  int status = 0;
  bool ended = false;
  while (!(ended = waitpid(child, &status, WNOHANG) == child) && !due()) usleep(200);
  if (!ended) {
    for (int k = 0; k < times; ++k) {
      kill(child, signal);
      if (k + 1 < times) usleep(3000);  // two at once would count as one
    }
    waitpid(child, &status, 0);
  }
  Result result;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.output = bytes(said);
  fs::remove(said);
  return result;
}

bool have_program(const std::string& name) { return run_program({"which", name}).status == 0; }

fs::path fresh_folder(const std::string& name) {
  // Threads that wait must not keep the processors busy where others work.
  setenv("OMP_WAIT_POLICY", "passive", 0);
  const fs::path folder = fs::temp_directory_path() / ("flowskin_" + name + "_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::string scene(const std::string& name) { return FLOWSKIN_SOURCE_DIR "/scenes/" + name; }

std::string bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> names;
  // A running program renames and removes files meanwhile: nothing here asks for a file that may be gone.
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (std::error_code gone; entry->is_regular_file(gone))
      names.push_back(entry->path().lexically_relative(folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string ffprobe(const fs::path& file, const std::string& entries) {
  std::string output = run_program({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0",
                                    "-show_entries", "stream=" + entries, "-of", "csv=p=0", file.string()})
                           .output;
  while (!output.empty() && (output.back() == '\n' || output.back() == ',')) output.pop_back();
  return output;
}

double mean_pixel_difference(const fs::path& a, const fs::path& b) {
  const tools::Image first = tools::read_image(a), second = tools::read_image(b);
  if (first.width != second.width || first.height != second.height) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = 0; i < first.pixels.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      sum += std::abs(int(first.pixels[i][channel]) - int(second.pixels[i][channel]));
  return sum / double(3 * first.pixels.size());
}

Table::Table(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  columns_ = split(line);
  while (std::getline(stream, line)) cells_.push_back(split(line));
}

std::size_t Table::index(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) throw std::runtime_error("no column " + column);
  return std::size_t(found - columns_.begin());
}

double Table::number(const std::string& column, std::size_t row) const {
  return std::stod(cells_.at(row).at(index(column)));
}

std::vector<std::string> Table::text(const std::string& column) const {
  std::vector<std::string> cells;
  for (const auto& row : cells_) cells.push_back(row.at(index(column)));
  return cells;
}

}  // namespace flowskin::end_to_end
