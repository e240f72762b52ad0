#include "measure.h"

#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>

#include <CLI/CLI.hpp>

namespace spanray::peers {
namespace {

double read_clock(clockid_t clock) {
  timespec t = {};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

}  // namespace

double wall_ms() { return read_clock(CLOCK_MONOTONIC); }
double cpu_ms() { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

std::string scene_name(const std::string& label, const std::string& path) {
  if (!label.empty()) return label;
  const size_t slash = path.find_last_of('/') + 1;
  return path.substr(slash, path.rfind('.') - slash);
}

Result<void> append_line(const std::string& path, const std::string& line) {
  std::ofstream file(path, std::ios::app);
  file << line << "\n";
  if (!file.flush()) return Error{"cannot be written", path};
  return {};
}

int fail(const CLI::App& app, const Error& error, int code) {
  std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.to_string().c_str());
  return code;
}

int run(CLI::App& app, int argc, char** argv, const std::function<int()>& compare) {
  try {
    app.parse(argc, argv);
    return compare();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? demo::kDone : demo::kWrongUsage;
  } catch (const demo::UsageError& error) {
    return fail(app, Error{error.what()}, demo::kWrongUsage);
  } catch (const std::exception& error) {
    return fail(app, Error{error.what()});
  }
}

}  // namespace spanray::peers
