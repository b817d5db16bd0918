// A film of a motion: how many pictures at which times, the script that draws them in a browser, and the pictures out
// of what it prints.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"

namespace anholon::cli {

enum class Record { mp4, gif, picture, folder };

// What was asked for, checked; times as they were given.
struct Recording {
  Record kind = Record::mp4;
  std::string output;
  int width = 1280, height = 720;
  double fps = 30;
  std::optional<double> seconds, at, part, from, to;  // part: of the way through the motion, in place of a time
  std::string frame = "observer";
  bool dark = false;
};

// Throws UsageError with what the user must correct.
Recording recording(const Options& o);

// Times of the motion, and how fast they follow each other.
struct Moments {
  double first = 0, last = 0;
  std::size_t count = 1;
  double fps = 30;
};

// Of a motion from `start` to `end`. Throws UsageError where there is nothing to record.
Moments moments(const Recording& r, double start, double end);

// Runs in the page after the viewer: draws the pictures A … B−1 of the address …#A-B, and leaves them as the page's
// only text.
std::string record_script(const Recording& r, const Moments& m);

struct Pictures {
  std::vector<std::string> png;  // in their order
  std::string error;             // why there are none, in the page's words
};

// Out of the text of a page that the script has left. Each must be a PNG of the size asked for.
Pictures pictures(const std::string& dom, std::size_t first, std::size_t last, int width, int height);

// Width and height of a PNG; nothing if it is none.
std::optional<std::pair<int, int>> png_size(const std::string& bytes);

// "frame-0001.png" for the first of so many
std::string frame_name(std::size_t index, std::size_t count);

}  // namespace anholon::cli
