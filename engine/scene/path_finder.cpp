#include "scene/path_finder.h"

#include <algorithm>
#include <filesystem>

#include "scene/text_input.h"

namespace spanray {
namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

const std::vector<std::string>& PathFinder::entries(const std::string& folder) {
  const auto [it, is_new] = entries_.try_emplace(folder);
  if (!is_new) return it->second;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    it->second.push_back(entry->path().filename().string());
  std::sort(it->second.begin(), it->second.end());
  return it->second;
}

bool PathFinder::inside_root(const std::string& path) const {
  std::error_code error;
  const fs::path root = fs::canonical(root_, error);
  if (error) return false;
  const fs::path real = fs::canonical(path, error);
  if (error) return false;
  return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
}

Result<std::string> PathFinder::find(const std::string& base, std::string_view name) {
  std::string slashes(name);
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  if (slashes.empty()) return Error{"no file name"};
  if (slashes.find('\0') != std::string::npos) return Error{"file name " + quoted(name) + " holds a NUL byte"};
  const bool absolute = slashes.front() == '/' || (slashes.size() > 1 && slashes[1] == ':');
  if (absolute && !allow_outside_) return Error{"file " + quoted(name) + " lies outside the scene's folder (see --allow-outside)"};
  std::string path = absolute ? std::string("/") : base;
  int depth = 0;
  for (size_t begin = 0; begin <= slashes.size();) {
    const size_t end = std::min(slashes.find('/', begin), slashes.size());
    const std::string part = slashes.substr(begin, end - begin);
    begin = end + 1;
    if (part.empty() || part == ".") continue;
    if (++depth > 100) return Error{"file name " + quoted(name) + " has too many parts"};
    std::error_code error;
    std::string next = path.back() == '/' ? path + part : path + "/" + part;
    if (part != ".." && !fs::exists(next, error)) {
      const std::string lower = lower_case(part);
      const std::vector<std::string>& names = entries(path);
      const auto it = std::find_if(names.begin(), names.end(), [&](const std::string& n) { return lower_case(n) == lower; });
      if (it == names.end()) return Error{"file " + quoted(name) + " not found"};
      next = path.back() == '/' ? path + *it : path + "/" + *it;
    }
    path = std::move(next);
  }
  std::error_code error;
  if (!allow_outside_ && !inside_root(path)) return Error{"file " + quoted(name) + " lies outside the scene's folder (see --allow-outside)"};
  if (fs::is_directory(path, error)) return Error{quoted(name) + " is a directory, not a file"};
  if (!fs::is_regular_file(path, error)) return Error{quoted(name) + " is not a regular file"};
  return path;
}

}  // namespace spanray
