// What both programs need around the measuring: clocks, medians, a file of results, main().
#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "command.h"

namespace spanray::peers {

double wall_ms();
double cpu_ms();  // of all threads of this process

// Milliseconds from making to stop(), by both clocks.
class Stopwatch {
 public:
  Stopwatch() : wall_(wall_ms()), cpu_(cpu_ms()) {}
  double wall() const { return wall_ms() - wall_; }
  double cpu() const { return cpu_ms() - cpu_; }

 private:
  double wall_, cpu_;
};

// 0 for an empty list.
inline double median(std::vector<double> v) {
  if (v.empty()) return 0;
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

// What the table calls a scene: its label, or the name of its file.
std::string scene_name(const std::string& label, const std::string& path);

// Adds a line to a file of JSON lines.
Result<void> append_line(const std::string& path, const std::string& line);

// Says what went wrong, after the program's name.
int fail(const CLI::App& app, const Error& error, int code = demo::kCouldNot);

// Parses and runs; the program's exit code.
int run(CLI::App& app, int argc, char** argv, const std::function<int()>& compare);

}  // namespace spanray::peers
