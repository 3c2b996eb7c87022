#include "tools/report/run_log.h"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>

#include "common/errors.h"
#include "tools/report/messages.h"

namespace flowskin::tools {

struct RunLog::Impl {
  std::shared_ptr<spdlog::sinks::basic_file_sink_st> file;
  std::unique_ptr<spdlog::logger> logger;
  std::string failure;
  bool quiet = false;
};

RunLog::RunLog(const std::filesystem::path& file, bool quiet, bool append) : impl_(std::make_unique<Impl>()) {
  try {
    impl_->file = std::make_shared<spdlog::sinks::basic_file_sink_st>(file.string(), !append);
  } catch (const spdlog::spdlog_ex& error) {
    throw RunError(fmt::format("cannot write the log {}: {}", file.string(), error.what()));
  }
  impl_->file->set_pattern("%Y-%m-%d %H:%M:%S  %v");
  impl_->quiet = quiet;
  impl_->logger = std::make_unique<spdlog::logger>("run", impl_->file);
  impl_->logger->set_level(spdlog::level::debug);
  impl_->logger->flush_on(spdlog::level::debug);
  impl_->logger->set_error_handler([impl = impl_.get()](const std::string& what) { impl->failure = what; });
}

RunLog::~RunLog() = default;

void RunLog::info(const std::string& message) {
  if (!impl_->quiet) say_line(message);
  impl_->logger->info("{}", printable(message));
}
void RunLog::detail(const std::string& message) { impl_->logger->debug("{}", printable(message)); }
void RunLog::warning(const std::string& message) {
  say_line(message);
  impl_->logger->warn("{}", printable(message));
}
const std::string& RunLog::failure() const { return impl_->failure; }

std::string version_text() { return "flowskin " FLOWSKIN_VERSION; }

std::string machine_text() {
  std::string processor = "unknown processor";
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.rfind("model name", 0) == 0) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  utsname system{};
  uname(&system);
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)) / (1 << 30);
  return fmt::format("{}, {} cores, {:.0f} GiB, {} {}", processor, sysconf(_SC_NPROCESSORS_ONLN), memory,
                     system.sysname, system.release);
}

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

}  // namespace flowskin::tools
