// Finds files that a scene names, as other systems wrote their names: backslashes, other letter case.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spanray/result.h"

namespace spanray {

class PathFinder {
 public:
  // Files must lie in root or below it (symbolic links followed) unless allow_outside.
  PathFinder(std::string root, bool allow_outside) : root_(std::move(root)), allow_outside_(allow_outside) {}

  // The path of the regular file `name`, looked for from folder `base`. Each component is taken as written if it exists,
  // else the first name in byte order that differs only in the case of ASCII letters. Error: the cause, without a file.
  Result<std::string> find(const std::string& base, std::string_view name);

 private:
  const std::vector<std::string>& entries(const std::string& folder);
  bool inside_root(const std::string& path) const;
  std::string root_;
  bool allow_outside_;
  std::map<std::string, std::vector<std::string>> entries_;  // folder -> its names, sorted
};

// The folder of a path, "." if it has none.
std::string folder_of(const std::string& path);

}  // namespace spanray
