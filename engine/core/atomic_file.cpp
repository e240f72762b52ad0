#include "core/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace spanray {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  return parent.empty() ? std::string(".") : parent.string();
}

Error system_error(const std::string& path, const char* what, int code) {
  return Error{std::string(what) + ": " + std::strerror(code), path};
}

// 0 or the errno of the write that failed.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes.remove_prefix(static_cast<size_t>(n));
  }
  return 0;
}

// Where the links from `path` end, whether anything is there or not; `path` itself if they go in a circle.
std::string link_target(const std::string& path) {
  fs::path place = path;
  std::error_code error;
  for (int links = 0; links < 40 && fs::is_symlink(place, error); ++links) {
    const fs::path target = fs::read_symlink(place, error);
    if (error) return path;
    place = target.is_absolute() ? target : place.parent_path() / target;
  }
  return fs::is_symlink(place, error) ? path : place.string();
}

// Devices and pipes, and what else must not be replaced by a regular file.
bool is_special(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

Result<void> write_special(const std::string& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return system_error(path, "cannot write", errno);
  int failure = write_all(file, bytes);
  if (::close(file) != 0 && failure == 0) failure = errno;
  return failure == 0 ? Result<void>() : system_error(path, "cannot write", failure);
}

}  // namespace

Result<void> check_writable(const std::string& path) {
  if (path.empty()) return Error{"cannot write: the name of the file is empty"};
  std::error_code ignored;
  if (is_special(path))
    return ::access(path.c_str(), W_OK) == 0 ? Result<void>() : Error{"cannot write: no permission", path};
  const std::string folder = folder_of(link_target(path));
  if (!fs::exists(folder, ignored)) return Error{"cannot write: the folder " + folder + " does not exist", path};
  if (!fs::is_directory(folder, ignored)) return Error{"cannot write: " + folder + " is not a folder", path};
  if (fs::is_directory(path, ignored)) return Error{"cannot write: it is a folder", path};
  if (::access(folder.c_str(), W_OK) != 0) return Error{"cannot write: no permission to write into " + folder, path};
  return {};
}

Result<void> write_file_atomic(const std::string& path, std::string_view bytes) {
  if (auto possible = check_writable(path); !possible) return possible;
  if (is_special(path)) return write_special(path, bytes);
  static std::atomic<unsigned> serial{0};
  const std::string target = link_target(path), temporary = target + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(serial++);
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return system_error(path, "cannot write", errno);
  int failure = write_all(file, bytes);
  if (::close(file) != 0 && failure == 0) failure = errno;
  if (failure == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) failure = errno;
  if (failure == 0) return {};
  ::unlink(temporary.c_str());
  return system_error(path, "cannot write", failure);
}

}  // namespace spanray
