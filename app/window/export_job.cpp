#include "app/window/export_job.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "app/panels/shell_words.h"
#include "app/support/errors.h"
#include "app/support/progress.h"

namespace topple::app {
namespace {

constexpr int k_niceness = 10;  // the window goes first
constexpr int k_polls = 200;    // times 10 ms, with a process that was asked to end

/// What it said last, without the program's name; empty: nothing.
std::string last_words(const std::string& errors) {
  constexpr std::string_view k_begin = "\ntopple: ";
  const std::string lines = '\n' + errors;
  const std::size_t said = lines.rfind(k_begin);
  if (said == std::string::npos) return {};
  const std::size_t begin = said + k_begin.size();
  return lines.substr(begin, lines.find('\n', begin) - begin);
}

}  // namespace

ExportJob::ExportJob(const std::string& program, std::vector<std::string> arguments, std::string result,
                     Makes makes)
    : result_(std::move(result)), errors_("export") {
  if (makes == Makes::folder) arguments.push_back(folder_.emplace(result_).part().string());
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("no pipe for the export: ") + std::strerror(errno));
  reports_ = host::Descriptor(ends[0]);
  const host::Descriptor writer(ends[1]);
  fcntl(reports_.get(), F_SETFL, O_NONBLOCK);
  process_.emplace(program, arguments, host::Streams{.errors = errors_.descriptor(), .extra = writer.get()},
                   std::vector{k_progress_variable + ("=" + std::to_string(host::k_extra_stream))});
  setpriority(PRIO_PROCESS, static_cast<id_t>(process_->number()), k_niceness);
}

ExportJob::~ExportJob() {
  cancel();
  for (int i = 0; i < k_polls && !done(); ++i) {
    update();
    if (!done()) usleep(10000);
  }
  if (done()) return;
  process_->signal(SIGKILL);
  end(process_->wait());
}

void ExportJob::cancel() {
  if (done() || cancelled_) return;
  cancelled_ = true;
  process_->signal(SIGINT);
}

bool ExportJob::update() {
  if (done()) return false;
  const std::string before = line_;
  const std::optional<host::Ended> ended = process_->poll();
  read_reports();
  if (ended) end(*ended);
  return ended || line_ != before;
}

void ExportJob::read_reports() {
  char bytes[4096];
  for (ssize_t n = 0; (n = read(reports_.get(), bytes, sizeof bytes)) > 0;)
    unread_.append(bytes, static_cast<std::size_t>(n));
  for (std::size_t end = 0; (end = unread_.find('\n')) != std::string::npos; unread_.erase(0, end + 1)) {
    const std::optional<ProgressReport> report = progress_in(unread_.substr(0, end));
    if (!report || !(report->total > 0)) continue;
    part_ = std::clamp(report->done / report->total, 0., 1.);
    line_ = say(window_words::k_export_progress, report->done, report->total, report->unit, report->rate,
                report->left);
  }
}

void ExportJob::end(const host::Ended& ended) {
  const bool good = ended.signal == 0 && ended.code == k_done;
  if (good && folder_) {
    try {
      folder_->commit();
    } catch (const host::FileError& error) {
      failure_ = error.what();
    }
  } else if (!good) {
    failure_ = last_words(errors_.content());
    if (failure_.empty()) failure_ = "ended with " + in_words(ended);
  }
  if (failure_.empty()) return;
  folder_.reset();
  host::remove_parts(result_, process_->number());
}

}  // namespace topple::app
