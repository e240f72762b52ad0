// How far something long is, on stderr: a line that is written over on a terminal, else a message every ten seconds.
#pragma once
#include <chrono>
#include <string>

namespace spanray::demo {

class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  // fraction: 0 to 1, not falling within a part.
  void show(double fraction) { show("", fraction); }
  void show(const std::string& part, double fraction);
  // Where nobody knows how much is left. how_far: such as "12 settings tried".
  void say(const std::string& part, const std::string& how_far);
  // Before anything else is said.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  // Whether it is time to say something.
  bool due(const std::string& part, Clock::time_point now);
  void put(const std::string& text) const;

  const std::string what_;
  const bool terminal_;
  std::string part_;
  Clock::time_point start_;  // of the part
  Clock::time_point shown_;
};

}  // namespace spanray::demo
