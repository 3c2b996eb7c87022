#include "tools/pipeline/run_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <utility>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"

namespace flowskin::tools {

namespace fs = std::filesystem;

namespace {

using FileIdentity = std::pair<dev_t, ino_t>;

/// The same for two names of one file, as std::filesystem::equivalent has it.
std::optional<FileIdentity> identity_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
  return FileIdentity{status.st_dev, status.st_ino};
}

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), kShown); ++k) text += (k > 0 ? ", " : "") + names[k];
  return names.size() > kShown ? text + fmt::format(" and {} more", names.size() - kShown) : text;
}

}  // namespace

RunFolder::RunFolder(const RunDirectory& directory) : directory_(directory), record_(RunRecord::read(directory)) {
  look_at_folder(directory.root());
  for (const fs::path& folder : directory.folders()) {
    std::error_code error;
    const fs::file_type type = fs::symlink_status(folder, error).type();
    if (type == fs::file_type::not_found) continue;
    if (type != fs::file_type::directory)
      in_place_of_folders_.push_back(folder.filename().string() +
                                     (type == fs::file_type::symlink ? " (a link)" : " (not a folder)"));
    look_at_folder(folder);
  }
  std::sort(names_.begin(), names_.end());
}

void RunFolder::look_at_folder(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::string name = entry->path().lexically_relative(directory_.root()).generic_string();
    if (RunDirectory::is_name_of_run(name)) names_.push_back(std::move(name));
  }
}

void RunFolder::check_inputs_stay(const std::vector<fs::path>& inputs) const {
  std::map<FileIdentity, fs::path> files;
  for (const fs::path& input : inputs)
    if (const auto identity = identity_of(input)) files.emplace(*identity, input);
  for (const std::string& name : names_) {
    const auto identity = identity_of(directory_.root() / name);
    const auto input = identity ? files.find(*identity) : files.end();
    if (input != files.end())
      throw InputError(
          fmt::format("{} is needed for this run (as {}), and a run into {} may overwrite it; give another folder to "
                      "--out",
                      (directory_.root() / name).string(), input->second.string(), directory_.root().string()));
  }
}

std::vector<std::string> RunFolder::unrecorded() const {
  std::vector<std::string> names;
  for (const std::string& name : names_) {
    std::error_code error;
    const bool is_folder = fs::symlink_status(directory_.root() / name, error).type() == fs::file_type::directory;
    if (!record_ || !record_->names(name) || is_folder) names.push_back(name);
  }
  return names;
}

void RunFolder::check_nothing_else() const {
  const std::vector<std::string> others = unrecorded();
  if (others.empty()) return;
  const std::string record = RunDirectory::kRecordName;
  throw InputError(fmt::format(
      "{} is not empty: a run would overwrite {}, and {} FlowSkin has written {}; move {} away, or give another "
      "folder to --out",
      directory_.root().string(), some_of(others),
      record_ ? "its " + record + " does not say that"
              : "there is no " + record + " (runs of version 0.1 have none) that says that",
      others.size() == 1 ? "it" : "them", others.size() == 1 ? "it" : "them"));
}

bool RunFolder::can_be_resumed() const {
  return std::any_of(names_.begin(), names_.end(),
                     [](const std::string& name) { return name.starts_with("checkpoint/frame_"); });
}

/// Why the default folder is not taken again without being asked; empty: it is.
std::string RunFolder::why_not_again(const std::string& scene) const {
  if (record_->scene() != scene) return fmt::format(" of another scene, {}", record_->scene());
  if (!record_->frames_done() && can_be_resumed()) return " that can be resumed";
  for (const std::string& name : names_)
    if (!record_->is_unchanged(directory_, name)) return fmt::format(", and {} was changed since", name);
  return "";
}

void RunFolder::refuse(const std::string& why_not) const {
  const std::string root = directory_.root().string();
  if (record_->frames_done())
    throw InputError(
        fmt::format("{} holds a finished run ({} frames){}: --overwrite replaces it, --resume with more --frames goes "
                    "on with it, and --out names another folder",
                    root, *record_->frames_done(), why_not));
  throw InputError(fmt::format(
      "{} holds an interrupted run{}: {}--overwrite replaces it, and --out names another folder", root, why_not,
      can_be_resumed() ? "--resume goes on with it, " : "(it has no checkpoint for --resume to go on from) "));
}

void RunFolder::check_may_begin(const RunOptions& options, const std::string& scene) const {
  if (!in_place_of_folders_.empty())
    throw InputError(
        fmt::format("{} is not empty: {} is where a run makes a folder of its own; move it away, or give "
                    "another folder to --out",
                    directory_.root().string(), some_of(in_place_of_folders_)));
  check_nothing_else();
  const bool holds_results = std::any_of(names_.begin(), names_.end(),
                                         [](const std::string& name) { return name != RunDirectory::kRecordName; });
  if (!holds_results || options.overwrite) return;
  const std::string why_not = options.out_is_default ? why_not_again(scene) : "";
  if (!options.out_is_default || !why_not.empty()) refuse(why_not);
}

void RunFolder::check_may_go_on() const {
  if (!record_)
    throw InputError(
        fmt::format("{} has no {}, which says what FlowSkin has written there (runs of version 0.1 have none): run the "
                    "scene anew into another folder",
                    directory_.root().string(), RunDirectory::kRecordName));
  check_nothing_else();
}

void RunFolder::clear(const std::string& scene) const {
  try {
    // Whatever happens on the way, the old record stays until its files are gone, and no longer calls the run done.
    if (record_) {
      const RunRecorder marks_as_begun(directory_, RunRecorder::Work::whole_run);
      for (const std::string& name : names_)
        if (name != RunDirectory::kRecordName && record_->names(name)) fs::remove(directory_.root() / name);
    }
    begin_record(directory_, scene);
    directory_.make_folders();
  } catch (const fs::filesystem_error& error) {
    throw RunError(fmt::format("cannot prepare the folder {}: {}", directory_.root().string(), error.code().message()));
  }
}

}  // namespace flowskin::tools
