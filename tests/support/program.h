// Runs the spanray program as a user would, and reads what it said.
#pragma once
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "support/temp_folder.h"

namespace spanray {

inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A child process whose output goes to files. Killed at the end of its life, if it still runs.
class Process {
 public:
  // environment: "NAME=value" adds or changes a variable, "NAME" removes it.
  Process(const std::vector<std::string>& arguments, const std::string& folder, const std::vector<std::string>& environment = {}) {
    out_path_ = folder_.file("out"), error_path_ = folder_.file("err");
    pid_ = ::fork();
    if (pid_ != 0) return;
    redirect(out_path_, STDOUT_FILENO);
    redirect(error_path_, STDERR_FILENO);
    if (::chdir(folder.c_str()) != 0) ::_exit(126);
    for (const std::string& entry : environment) {
      const size_t equals = entry.find('=');
      if (equals == std::string::npos) ::unsetenv(entry.c_str());
      else ::setenv(entry.substr(0, equals).c_str(), entry.substr(equals + 1).c_str(), 1);
    }
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  ~Process() {
    if (!wait(0)) ::kill(pid_, SIGKILL), wait(10);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // True if it ended within the time.
  bool wait(double seconds) {
    const auto start = std::chrono::steady_clock::now();
    while (!ended_) {
      int status = 0;
      if (::waitpid(pid_, &status, WNOHANG) == pid_) {
        ended_ = true;
        code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
        break;
      }
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > seconds) return false;
      ::usleep(2000);
    }
    return true;
  }
  int code() const { return code_; }  // 1000 + signal, if a signal ended it
  pid_t pid() const { return pid_; }
  void send(int signal) { if (!ended_) ::kill(pid_, signal); }
  std::string out() const { return read_text(out_path_); }
  std::string error() const { return read_text(error_path_); }

 private:
  static void redirect(const std::string& path, int descriptor) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(126);
    ::close(file);
  }
  TempFolder folder_;
  std::string out_path_, error_path_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int code_ = -1;
};

struct Ran {
  int code;
  std::string out, error;
};

// spanray with these arguments, in `folder`; code -1 if it did not end within the time.
inline Ran run_program(std::vector<std::string> arguments, const std::string& folder,
                       const std::vector<std::string>& environment = {}, double seconds = 60) {
  arguments.insert(arguments.begin(), SPANRAY_PROGRAM);
  Process process(arguments, folder, environment);
  const bool ended = process.wait(seconds);
  return {ended ? process.code() : -1, process.out(), process.error()};
}

}  // namespace spanray
