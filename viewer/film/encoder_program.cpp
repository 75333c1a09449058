// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/encoder_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "bridges/base/child_program.hpp"
#include "sim/config/message_text.hpp"

namespace viewer {

namespace {

std::vector<std::string> arguments_of(const FilmFormat& format, const std::vector<std::string>& codec,
                                      const std::string& part) {
  std::vector<std::string> arguments{"ffmpeg",
                                     "-hide_banner",
                                     "-loglevel",
                                     "error",
                                     "-y",
                                     "-f",
                                     "rawvideo",
                                     "-pix_fmt",
                                     "rgb24",
                                     "-s",
                                     fmt::format("{}x{}", format.width, format.height),
                                     "-r",
                                     fmt::format("{}", format.fps),
                                     "-i",
                                     "pipe:0",
                                     "-an"};
  arguments.insert(arguments.end(), codec.begin(), codec.end());
  // Without the prefix ffmpeg takes a path with a colon for a protocol.
  arguments.push_back("file:" + part);
  return arguments;
}

}  // namespace

bool has_ffmpeg() {
  return bridges::is_program("ffmpeg");
}

EncoderProgram::EncoderProgram(std::string file, const FilmFormat& format, const std::vector<std::string>& codec)
    : file_(std::move(file)), log_(file_.path(), ".log") {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw FilmError(file_.path() + ": no pipe to ffmpeg: " + std::strerror(errno));
  const bridges::FileDescriptor read_end(ends[0]);
  input_ = bridges::FileDescriptor(ends[1]);
  fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);  // fewer switches between the programs
  bridges::ChildProgram program{"ffmpeg", arguments_of(format, codec, file_.part_name()), bridges::own_environment(),
                                log_.part_name(), read_end.number()};
  const int error = bridges::start_child(program, pid_);
  if (error != 0) throw FilmError(file_.path() + ": ffmpeg cannot be started: " + std::strerror(error));
}

EncoderProgram::~EncoderProgram() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    wait();
  }
}

int EncoderProgram::wait() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

std::string EncoderProgram::last_words() const {
  std::ifstream log(log_.part_name());
  std::string line, last;
  while (std::getline(log, line))
    if (!line.empty()) last = line;
  return sim::printable(sim::shortened(last));
}

void EncoderProgram::fail(int status) {
  const std::string words = last_words();
  const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                              : fmt::format("ended with exit code {}", WEXITSTATUS(status));
  throw FilmError(fmt::format("{}: ffmpeg {}{}", file_.path(), how, words.empty() ? "" : ": " + words));
}

void EncoderProgram::add(const sim::Image8& frame) {
  const std::uint8_t* at = frame.data.data();
  std::size_t left = frame.data.size();
  while (left > 0) {
    const ssize_t written = write(input_.number(), at, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      // The encoder has ended: its own message says why.
      input_ = bridges::FileDescriptor();
      fail(wait());
    }
    at += written;
    left -= static_cast<std::size_t>(written);
  }
}

void EncoderProgram::finish() {
  input_ = bridges::FileDescriptor();  // the end of its input
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail(status);
  file_.finish();
}

}  // namespace viewer
