// Reads tests/hostile/expectations.txt: one line a file, what loading it must give.
//   FILE  fails LINE | TEXT       an error at that line (0: none) whose message holds TEXT
//   FILE  loads KEY=NUMBER... | TEXT   a scene of so many triangles, materials, ...; TEXT, if any, is part of one of its messages
//   FILE  picture WxHxCHANNELSxBITS    decoded samples
#pragma once
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace spanray {

struct Expectation {
  std::string file;                   // below tests/hostile
  std::string outcome;                // "fails", "loads", "picture"
  int line = 0;                       // of an error
  std::map<std::string, int> counts;  // of a scene
  std::string size;                   // of a picture
  std::string says;
};

inline Expectation parse_expectation(const std::string& text) {
  Expectation e;
  const size_t bar = text.find('|');
  std::istringstream words(text.substr(0, bar));
  words >> e.file >> e.outcome;
  for (std::string word; words >> word;) {
    const size_t equals = word.find('=');
    if (e.outcome == "fails") e.line = std::stoi(word);
    else if (equals != std::string::npos) e.counts[word.substr(0, equals)] = std::stoi(word.substr(equals + 1));
    else e.size = word;
  }
  if (bar != std::string::npos && bar + 2 < text.size()) e.says = text.substr(bar + 2);
  return e;
}

inline std::vector<Expectation> read_expectations(const std::string& path) {
  std::ifstream file(path);
  std::vector<Expectation> list;
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line[0] != '#') list.push_back(parse_expectation(line));
  return list;
}

}  // namespace spanray
