// Whether a run may use a folder: nothing is touched that FlowSkin has not written, or that the run is made from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/pipeline/run_directory.h"
#include "tools/pipeline/run_options.h"
#include "tools/pipeline/run_record.h"

namespace flowskin::tools {

/// What is in the folder of a run before the run begins. To be looked at with the lock only.
class RunFolder {
 public:
  /// @throws InputError where its record is something else
  explicit RunFolder(const RunDirectory& directory);

  /// Whether FlowSkin has kept record of what it wrote there.
  bool has_record() const { return record_.has_value(); }
  /// @throws InputError where one of these files is among those that the run may write, links looked through.
  void check_inputs_stay(const std::vector<std::filesystem::path>& inputs) const;
  /// @param scene as RunRecord::scene(). @throws InputError with the choice that the user has.
  void check_may_begin(const RunOptions& options, const std::string& scene) const;
  /// Whether a run may go on there, or pictures be added.
  void check_may_go_on() const;
  /// Removes what the record names, and begins a new one. @throws RunError
  void clear(const std::string& scene) const;

 private:
  void look_at_folder(const std::filesystem::path& folder);
  std::vector<std::string> unrecorded() const;
  void check_nothing_else() const;
  bool can_be_resumed() const;
  std::string why_not_again(const std::string& scene) const;
  [[noreturn]] void refuse(const std::string& why_not) const;

  const RunDirectory directory_;
  std::optional<RunRecord> record_;
  std::vector<std::string> names_;  // that runs write and that are there, relative to the folder, ascending
  std::vector<std::string> in_place_of_folders_;  // names of folders that are something else, and what
};

}  // namespace flowskin::tools
