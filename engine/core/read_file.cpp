#include "core/read_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace spanray {
namespace {

Result<std::string> read_open_file(int file, const std::string& path, size_t max_bytes) {
  struct stat status;
  if (::fstat(file, &status) != 0) return Error{std::string("cannot read: ") + std::strerror(errno), path};
  if (S_ISDIR(status.st_mode)) return Error{"cannot read: it is a folder", path};
  if (!S_ISREG(status.st_mode)) return Error{"cannot read: it is not a regular file", path};
  if (static_cast<size_t>(status.st_size) > max_bytes)
    return Error{"cannot read: " + std::to_string(status.st_size) + " bytes are more than the limit of " + std::to_string(max_bytes), path};
  std::string bytes(static_cast<size_t>(status.st_size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return Error{std::string("cannot read: ") + std::strerror(errno), path};
    if (n == 0) break;  // shorter than it was a moment ago
    done += static_cast<size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace

Result<std::string> read_file(const std::string& path, size_t max_bytes) {
  if (path.empty()) return Error{"cannot read: the name of the file is empty"};
  // Without O_NONBLOCK, opening a pipe that nobody writes to would wait for ever.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return Error{std::string("cannot read: ") + std::strerror(errno), path};
  Result<std::string> result = read_open_file(file, path, max_bytes);
  ::close(file);
  return result;
}

}  // namespace spanray
