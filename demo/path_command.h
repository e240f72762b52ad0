// The options of `reference` that ask for the rendering equation, and the work.
#pragma once
#include <string>

#include "command.h"
#include "job.h"
#include "path_file.h"

namespace spanray::demo {

// A picture, and what to say of how it was made.
struct PathPicture {
  Framebuffer picture;
  std::string text;      // for its metadata
  bool stopped = false;  // by a signal, before all paths were made
  Result<void> saved;    // the accumulation file
};

struct PathCommand {
  uint32_t paths = 0;  // viewing rays a pixel; 0: not this mode
  PathOptions options;
  std::string accumulate;  // empty: none

  // Adds the options; returns --paths, which the others need.
  CLI::Option* add_to(CLI::App& command);
  // Traces paths, from where the accumulation file left off, and says what is to be said. A signal stops it after the pass.
  // Errors: as of trace_paths() and read_path_file(); more paths in the file than are asked for.
  Result<PathPicture> render(const Job& job) const;

 private:
  PathMeaning meaning(const Job& job) const;
  Result<PathSums> begin(const Job& job) const;  // what the accumulation file holds; nothing if there is none
  std::string words() const;
};

}  // namespace spanray::demo
