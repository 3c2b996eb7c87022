#include "scenes/io/atomic_file.h"

#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>
#include <vector>

#include "common/errors.h"
#include "tests/scenes/io_fixture.h"

namespace flowskin::scenes::atomic_file_test {
namespace {

class AtomicFileTest : public IoTest {};

TEST_F(AtomicFileTest, WritesAndReplaces) {
  write_file(path("a.txt"), "first, and longer");
  EXPECT_EQ(read_text(path("a.txt")), "first, and longer");
  write_file(path("a.txt"), std::string("s\0nd", 4));
  EXPECT_EQ(read_text(path("a.txt")), std::string("s\0nd", 4));
  write_file(path("empty"), "");
  EXPECT_EQ(std::filesystem::file_size(path("empty")), 0U);
  EXPECT_EQ(files_in_folder(), 2U);
}

TEST_F(AtomicFileTest, GivesTheRightsThatTheUserWants) {
  write_file(path("a.txt"), "x");
  const mode_t mask = ::umask(0);
  ::umask(mask);
  EXPECT_EQ(static_cast<unsigned>(std::filesystem::status(path("a.txt")).permissions()), 0666U & ~mask);
}

TEST_F(AtomicFileTest, NamesTheMissingFolder) {
  const std::string message = message_of<RunError>([&] { write_file(path("no/such/a.txt"), "x"); });
  EXPECT_NE(message.find("a.txt: No such file or directory"), std::string::npos) << message;
  EXPECT_NE(message.find("make the folder " + path("no/such").string()), std::string::npos) << message;
}

TEST_F(AtomicFileTest, RefusesAFileInPlaceOfTheFolderAndAFolderInPlaceOfTheFile) {
  write_file(path("a"), "kept");
  message_of<RunError>([&] { write_file(path("a") / "b.txt", "x"); });
  EXPECT_EQ(read_text(path("a")), "kept");
  std::filesystem::create_directories(path("folder.obj"));
  const std::string message = message_of<RunError>([&] { write_file(path("folder.obj"), "x"); });
  EXPECT_NE(message.find("a folder has the name of the file"), std::string::npos) << message;
  EXPECT_EQ(files_in_folder(), 2U) << "the draft stayed behind";
  message_of<RunError>([&] { write_file(path("folder.obj/"), "x"); });
}

TEST_F(AtomicFileTest, RefusesAFolderWithoutRights) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  std::filesystem::create_directories(path("closed"));
  std::filesystem::permissions(path("closed"), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const std::string message = message_of<RunError>([&] { write_file(path("closed") / "a.txt", "x"); });
  EXPECT_NE(message.find("Permission denied"), std::string::npos) << message;
  std::filesystem::permissions(path("closed"), std::filesystem::perms::owner_all);
}

TEST_F(AtomicFileTest, KeepsTheOldFileWhereTheNewOneIsTooLarge) {
  write_file(path("a.txt"), "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000, before.rlim_max};
  auto* handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = message_of<RunError>([&] { write_file(path("a.txt"), std::string(5000, 'x')); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_EQ(read_text(path("a.txt")), "old");
  EXPECT_EQ(files_in_folder(), 1U);
}

/// In a child process with a mount of its own: 0 good, 1 wrong, 77 where mounting is not allowed.
int write_to_a_full_disk(const std::filesystem::path& folder) {
  if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return 77;
  if (::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=64k") != 0) return 77;
  try {
    write_file(folder / "small", "fits");
    write_file(folder / "small", std::string(1 << 20, 'x'));
  } catch (const RunError& error) {
    const bool says_so =
        std::string(error.what()).find("No space left on device; free some space") != std::string::npos;
    const bool is_kept = std::filesystem::file_size(folder / "small") == 4;
    const auto files = std::distance(std::filesystem::directory_iterator(folder), {});
    return says_so && is_kept && files == 1 ? 0 : 1;
  }
  return 1;
}

TEST_F(AtomicFileTest, SeesAFullDisk) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(write_to_a_full_disk(folder_));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "needs the right to mount a file system";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(AtomicFileTest, OnlyDraftsAreRemovedAsSuch) {
  for (const char* name : {".frame_0001.ply.123-0.part", ".a.1-22.part"}) std::ofstream(path(name)) << "half";
  for (const char* name : {"mine.part", ".mine.part", ".a.1-.part", ".a.-1.part", ".1-2.part", "a.1-2.part",
                           ".a.1-2.part.txt", "film.part.mp4"})
    std::ofstream(path(name)) << "mine";
  remove_stale_drafts(folder_);
  EXPECT_EQ(files_in_folder(), 8U);
}

TEST_F(AtomicFileTest, AnObserverKnowsOfFilesBeforeTheyHaveTheirNames) {
  std::string seen;
  observe_commits([&](const std::filesystem::path& file, const std::filesystem::path& draft, bool durable) {
    seen += file.filename().string() + (std::filesystem::exists(file) ? " is there" : " is not there");
    seen += durable ? " durable " : " ";
    EXPECT_EQ(read_text(draft), "text");
    if (file.filename() == "no.txt") throw RunError("not this one");
  });
  write_file(path("a.txt"), "text");
  EXPECT_THROW(write_file(path("no.txt"), "text"), RunError);
  observe_commits({});
  write_file(path("b.txt"), "text");
  EXPECT_EQ(seen, "a.txt is not there no.txt is not there ");
  EXPECT_EQ(files_in_folder(), 2U);
}

TEST_F(AtomicFileTest, ABatchGivesAllNamesAtOnceOrNone) {
  write_file(path("a.txt"), "old");
  {
    FileBatch batch;
    write_file(path("a.txt"), "new");
    write_file(path("b.txt"), "b");
    write_file(path("b.txt"), "c");
    EXPECT_EQ(read_text(path("a.txt")), "old");
    EXPECT_FALSE(std::filesystem::exists(path("b.txt")));
    AtomicFile now(path("now.txt"));
    now.commit(true);  // needs no batch
    EXPECT_TRUE(std::filesystem::exists(path("now.txt")));
    EXPECT_THROW(FileBatch(), std::logic_error);
    batch.commit();
    EXPECT_EQ(read_text(path("a.txt")), "new");
    EXPECT_EQ(read_text(path("b.txt")), "c");
    write_file(path("later.txt"), "x");
  }
  {
    const FileBatch batch;
    write_file(path("a.txt"), "never");
  }
  EXPECT_EQ(read_text(path("a.txt")), "new");
  EXPECT_EQ(files_in_folder(), 3U) << "a draft was left, or what was not committed has its name";
}

TEST_F(AtomicFileTest, ABatchThatCannotGoOnSaysWhereAndLeavesNoDrafts) {
  write_file(path("a.txt"), "old");
  std::filesystem::create_directories(path("b.txt"));
  const std::string message = message_of<RunError>([&] {
    FileBatch batch;
    write_file(path("a.txt"), "new");
    write_file(path("b.txt"), "b");
    write_file(path("c.txt"), "c");
    batch.commit();
  });
  EXPECT_NE(message.find("b.txt"), std::string::npos) << message;
  EXPECT_EQ(files_in_folder(), 2U);
}

TEST_F(AtomicFileTest, ThreadsThatWriteTheSameFileLeaveOneOfThem) {
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([this, k] {
      for (int i = 0; i < 20; ++i) write_file(path("a.txt"), std::string(10000, static_cast<char>('a' + k)));
    });
  for (std::thread& thread : threads) thread.join();
  const std::string text = read_text(path("a.txt"));
  EXPECT_EQ(text, std::string(10000, text.at(0)));
  EXPECT_EQ(files_in_folder(), 1U);
}

}  // namespace
}  // namespace flowskin::scenes::atomic_file_test
