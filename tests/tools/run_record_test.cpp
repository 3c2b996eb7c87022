// The record of what FlowSkin has written into a folder, and what that allows; the lock of a folder.
#include "tools/pipeline/run_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <barrier>
#include <fstream>
#include <memory>
#include <thread>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "tools/pipeline/run_folder.h"

namespace flowskin::tools::run_record_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class RunRecords : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("flowskin_record_" + std::to_string(getpid()) + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// A run that wrote these files; it ended where `frames` is not negative.
  void write_run(const std::vector<std::string>& names, int frames) const {
    begin_record(directory(), "/scenes/a.json");
    directory().make_folders();
    RunRecorder recorder(directory(), RunRecorder::Work::whole_run);
    for (const std::string& name : names) scenes::write_file(directory().root() / name, name);
    if (frames >= 0) recorder.finish(frames);
  }
  RunDirectory directory() const { return RunDirectory(folder_); }
  RunRecord record() const { return RunRecord::read(directory()).value(); }
  std::string refusal(const RunOptions& options) const {
    try {
      RunFolder(directory()).check_may_begin(options, "/scenes/a.json");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(RunRecords, SayWhatWasWrittenAndWhetherItIsDone) {
  EXPECT_FALSE(RunRecord::read(directory()).has_value());
  write_run({"surface/frame_0000.obj", "frames.csv", "frames.csv"}, -1);
  EXPECT_EQ(record().scene(), "/scenes/a.json");
  EXPECT_FALSE(record().frames_done().has_value());
  EXPECT_TRUE(record().names("surface/frame_0000.obj"));
  EXPECT_TRUE(record().names("log.txt"));
  EXPECT_TRUE(record().names("flowskin_run.txt"));
  EXPECT_FALSE(record().names("surface/frame_0001.obj"));
  RunRecorder(directory(), RunRecorder::Work::pictures).finish(7);
  EXPECT_EQ(record().frames_done(), 7);
  RunRecorder(directory(), RunRecorder::Work::whole_run);
  EXPECT_FALSE(record().frames_done().has_value());
}

TEST_F(RunRecords, KnowChangedFiles) {
  write_run({"surface/frame_0000.obj", "scene.json"}, 0);
  EXPECT_TRUE(record().is_unchanged(directory(), "surface/frame_0000.obj"));
  EXPECT_FALSE(record().is_unchanged(directory(), "surface/frame_0001.obj"));
  put("surface/frame_0000.obj", "another length");
  EXPECT_FALSE(record().is_unchanged(directory(), "surface/frame_0000.obj"));
  fs::last_write_time(folder_ / "scene.json", fs::last_write_time(folder_ / "scene.json") + std::chrono::seconds(1));
  EXPECT_FALSE(record().is_unchanged(directory(), "scene.json"));
  fs::rename(folder_ / "scene.json", folder_ / "moved");
  fs::create_symlink(folder_ / "moved", folder_ / "scene.json");
  EXPECT_FALSE(record().is_unchanged(directory(), "scene.json"));
}

TEST_F(RunRecords, ComeBeforeTheFile) {
  // Killed between the record and the name: the file that was there before still counts as unchanged.
  write_run({"frames.csv"}, -1);
  {
    RunRecorder recorder(directory(), RunRecorder::Work::whole_run);
    fs::create_directories(folder_ / "compare.md");  // so that the file cannot get its name
    put("compare.md/in_the_way", "");
    EXPECT_THROW(scenes::write_file(directory().compare_markdown(), "x"), RunError);
  }
  EXPECT_TRUE(record().names("compare.md"));
  EXPECT_TRUE(record().is_unchanged(directory(), "frames.csv"));
  // A folder is never taken for a file that was written.
  RunOptions options;
  options.overwrite = true;
  EXPECT_THAT(refusal(options), HasSubstr("compare.md"));
}

TEST_F(RunRecords, MayEndInHalfALine) {
  write_run({"frames.csv"}, -1);
  std::ofstream(folder_ / "flowskin_run.txt", std::ios::app) << "file scene.json 12";
  EXPECT_FALSE(record().names("scene.json"));
  { RunRecorder(directory(), RunRecorder::Work::pictures).finish(3); }
  EXPECT_FALSE(record().names("scene.json"));
  EXPECT_EQ(record().frames_done(), 3);
}

TEST_F(RunRecords, OfOthersAreRefused) {
  for (const std::string& text : {std::string(), std::string("my notes\n"), std::string("flowskin run 2\n")}) {
    put("flowskin_run.txt", text);
    EXPECT_THROW(RunRecord::read(directory()), InputError) << text;
  }
  fs::remove(folder_ / "flowskin_run.txt");
  fs::create_symlink(folder_ / "nowhere", folder_ / "flowskin_run.txt");
  EXPECT_THROW(RunRecord::read(directory()), InputError);
}

TEST_F(RunRecords, NeverRemoveWhatIsNoFileOfARun) {
  write_run({"surface/frame_0000.obj"}, 0);
  put("mine.txt", "mine");
  put("surface/mine.obj", "mine");
  // Somebody has written into the record.
  std::ofstream(folder_ / "flowskin_run.txt", std::ios::app)
      << "file mine.txt 4 1\nfile surface/mine.obj 4 1\nfile ../mine.txt 4 1\nfile /etc/passwd 4 1\n";
  RunFolder(directory()).clear("/scenes/a.json");
  EXPECT_TRUE(fs::exists(folder_ / "mine.txt"));
  EXPECT_TRUE(fs::exists(folder_ / "surface/mine.obj"));
  EXPECT_FALSE(fs::exists(folder_ / "surface/frame_0000.obj"));
}

TEST_F(RunRecords, TheDefaultFolderIsTakenAgainWhereNothingIsLost) {
  RunOptions chosen, standard;
  standard.out_is_default = true;
  EXPECT_EQ(refusal(chosen), "");
  write_run({"scene.json"}, -1);
  EXPECT_EQ(refusal(standard), "") << "there is no checkpoint";
  EXPECT_THAT(refusal(chosen), HasSubstr("interrupted"));
  write_run({"scene.json", "checkpoint/frame_0010.bin"}, -1);
  EXPECT_THAT(refusal(standard), HasSubstr("can be resumed"));
  write_run({"scene.json", "checkpoint/frame_0010.bin"}, 10);
  EXPECT_EQ(refusal(standard), "");
  EXPECT_THAT(refusal(chosen), HasSubstr("finished run (10 frames)"));
  put("scene.json", "changed");
  EXPECT_THAT(refusal(standard), HasSubstr("scene.json was changed"));
}

TEST_F(RunRecords, LossesAreNoticed) {
  begin_record(directory(), "a");
  directory().make_folders();
  RunRecorder recorder(directory(), RunRecorder::Work::whole_run);
  scenes::write_file(directory().surface(0, ".obj"), "x");
  scenes::write_file(directory().surface(1, ".obj"), "x");
  recorder.keep_frame();
  {  // A frame that was not finished is none that is lost.
    const scenes::FileBatch dropped;
    scenes::write_file(directory().surface(2, ".obj"), "x");
  }
  EXPECT_EQ(recorder.loss(), "");
  fs::remove(directory().surface(0, ".obj"));
  EXPECT_THAT(recorder.loss(), HasSubstr("1 of the 2 files"));
  fs::rename(folder_, folder_.string() + "_moved");
  EXPECT_THAT(recorder.loss(), HasSubstr("removed or replaced"));
  fs::create_directories(folder_ / "surface");
  EXPECT_THROW(scenes::write_file(directory().surface(2, ".obj"), "x"), RunError);
  EXPECT_TRUE(fs::is_empty(folder_ / "surface"));
  fs::remove_all(folder_.string() + "_moved");
}

TEST_F(RunRecords, NamesOfRuns) {
  for (const char* name : {"scene.json", "surface/frame_0000.obj", "surface/frame_12345.vtp", "images/compare_0001.png",
                           "checkpoint/frame_0010.bin", "checkpoint/frame_-001.bin", "particles/particles.pvd"})
    EXPECT_TRUE(RunDirectory::is_name_of_run(name)) << name;
  for (const char* name : {"", "scene.json2", "frame_0000.obj", "surface/frame_.obj", "surface/frame_1a.obj",
                           "surface/frame_0000.obj.bak", "surface/surface.blend", "../scene.json", "images/wood.png"})
    EXPECT_FALSE(RunDirectory::is_name_of_run(name)) << name;
}

TEST_F(RunRecords, ALockIsForOneAndLeavesNoEmptyFolders) {
  const RunDirectory inner(folder_ / "a/b");
  {
    RunLock first;
    first.create(inner);
    RunLock second;
    EXPECT_THROW(second.create(inner), InputError);
    EXPECT_TRUE(fs::exists(inner.root()));
  }
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  RunLock none;
  EXPECT_FALSE(none.take(inner));
  {
    RunLock third;
    third.create(inner);
    put("a/b/mine.txt", "mine");
  }
  EXPECT_TRUE(fs::exists(folder_ / "a/b/mine.txt"));
}

TEST_F(RunRecords, WhoeverLosesTheLockLeavesTheFolderToTheWinner) {
  const RunDirectory directory(folder_ / "a/b");
  for (int round = 0; round < 1000; ++round) {
    std::barrier both(2);
    std::atomic<int> winners = 0;
    const auto contend = [&] {
      both.arrive_and_wait();
      auto lock = std::make_unique<RunLock>();
      bool won = true;
      try {
        lock->create(directory);
      } catch (const InputError&) {
        won = false;
        lock.reset();
      }
      both.arrive_and_wait();
      EXPECT_TRUE(!won || fs::exists(directory.root())) << round;
      winners += won;
    };
    std::thread other(contend);
    contend();
    other.join();
    EXPECT_EQ(winners, 1);
    fs::remove_all(folder_ / "a");
  }
}

}  // namespace
}  // namespace flowskin::tools::run_record_test
