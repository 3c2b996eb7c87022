// Videos: what ffprobe says of them, and what is left when it goes wrong.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "common/errors.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/render/video.h"

namespace flowskin::tools::video_test {
namespace {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A folder of five numbered pictures, removed at the end. Its name holds what shells and patterns trip over.
class Video : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!have_ffmpeg()) GTEST_SKIP() << "no ffmpeg on the path";
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("flowskin 100%d it's \"") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_pictures(int width, int height) const {
    for (int k = 0; k < 5; ++k) {
      Image image{width, height, std::vector<Color>(std::size_t(width) * std::size_t(height), Color{40, 90, 200})};
      for (int y = 0; y < height; ++y) image.at((10 * k) % width, y) = {255, 255, 0};
      write_png(folder_ / ("frame_000" + std::to_string(k) + ".png"), image);
    }
  }
  fs::path pattern() const { return folder_ / "frame_%04d.png"; }
  // codec,width,height,pix_fmt,rate,count
  static std::string probe(const fs::path& file) {
    // A name without quotes for the shell, and one of this process's own: tests run side by side.
    const fs::path plain = fs::path(::testing::TempDir()) / ("flowskin_probe_" + std::to_string(::getpid()) + ".mp4");
    fs::copy_file(file, plain, fs::copy_options::overwrite_existing);
    const std::string command =
        "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
        "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
        plain.string();
    std::string answer;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 256> line{};
    while (pipe != nullptr && fgets(line.data(), int(line.size()), pipe) != nullptr) answer += line.data();
    if (pipe != nullptr) pclose(pipe);
    fs::remove(plain);
    return answer.substr(0, answer.find('\n'));
  }

  fs::path folder_;
};

TEST_F(Video, HasTheRightSizeRateAndNumberOfFrames) {
  write_pictures(96, 64);
  encode_video(pattern(), 25, folder_ / "film.mp4");
  EXPECT_EQ(probe(folder_ / "film.mp4"), "h264,96,64,yuv420p,25/1,5");
  EXPECT_FALSE(fs::exists(folder_ / "film.part.mp4"));
}

TEST_F(Video, OddSizesAreCutToEven) {
  write_pictures(97, 65);
  encode_video(pattern(), 29.97, folder_ / "film.mp4");
  EXPECT_EQ(probe(folder_ / "film.mp4"), "h264,96,64,yuv420p,2997/100,5");
}

TEST_F(Video, SameBytesEachTime) {
  write_pictures(96, 64);
  encode_video(pattern(), 30, folder_ / "a.mp4");
  encode_video(pattern(), 30, folder_ / "b.mp4");
  const std::string a = read_bytes(folder_ / "a.mp4");
  EXPECT_GT(a.size(), 500u);
  EXPECT_TRUE(a == read_bytes(folder_ / "b.mp4"));
}

TEST_F(Video, FailureLeavesNothingAndSaysWhy) {
  try {
    encode_video(pattern(), 30, folder_ / "film.mp4");  // there are no pictures
    FAIL() << "no error";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("film.mp4"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  write_pictures(96, 64);
  EXPECT_THROW(encode_video(pattern(), 30, folder_ / "no" / "such" / "film.mp4"), RunError);
  EXPECT_FALSE(fs::exists(folder_ / "no"));
}

TEST_F(Video, AnOlderFileSurvivesAFailure) {
  std::ofstream(folder_ / "film.mp4") << "old";
  EXPECT_THROW(encode_video(pattern(), 30, folder_ / "film.mp4"), RunError);
  EXPECT_EQ(read_bytes(folder_ / "film.mp4"), "old");
}

TEST_F(Video, ImpossibleRatesAreRefused) {
  EXPECT_THROW(encode_video(pattern(), 0, folder_ / "film.mp4"), InputError);
  EXPECT_THROW(encode_video(pattern(), -1, folder_ / "film.mp4"), InputError);
}

TEST(VideoWithoutFfmpeg, IsFoundMissing) {
  const char* path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  setenv("PATH", "/nowhere:/neither", 1);
  EXPECT_FALSE(have_ffmpeg());
  EXPECT_THROW(encode_video("frame_%04d.png", 30, fs::path(::testing::TempDir()) / "film.mp4"), RunError);
  setenv("PATH", before.c_str(), 1);
}

TEST_F(Video, OfAFolderWithGapsIsNotMadeAndSaysHow) {
  const RunDirectory directory(folder_);
  fs::create_directories(directory.image_folder());
  const Image image{16, 16, std::vector<Color>(256, Color{40, 90, 200})};
  for (int frame : {80, 81, 82}) write_png(directory.surface_image(frame), image);
  std::string said;
  make_videos(directory, 30, [&](const std::string& line) { said += line; });
  EXPECT_NE(said.find("3 pictures of 83 frames"), std::string::npos) << said;
  EXPECT_NE(said.find("`flowskin render"), std::string::npos) << said;
  EXPECT_FALSE(fs::exists(directory.surface_video()));
}

}  // namespace
}  // namespace flowskin::tools::video_test
