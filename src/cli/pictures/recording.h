// A film of a motion: number and times of the pictures, the script that draws them in a browser, and the extraction of
// the pictures from the browser's output.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"

namespace anholon::cli {

enum class Record { mp4, gif, picture, folder };

// The recording that the options ask for, checked; times are kept as written.
struct Recording {
  Record kind = Record::mp4;
  std::string output;
  int width = 1280, height = 720;
  double fps = 30;
  std::optional<double> seconds, at, part, from, to;  // part: fraction of the motion, instead of a time
  std::string frame = "observer";
  bool dark = false;
};

// Returns the recording that the options ask for. Throws UsageError for mistakes of the user.
Recording recording(const RenderCommand& o);

// Times of the motion, and the rate at which they are shown.
struct Moments {
  double first = 0, last = 0;
  std::size_t count = 1;
  double fps = 30;
};

// The moments of a motion from `start` to `end`. Throws UsageError if there is nothing to record.
Moments moments(const Recording& r, double start, double end);

// A script that runs in the page after the viewer: it draws the pictures A … B−1 of the address …#A-B, and leaves them
// as the page's only text.
std::string record_script(const Recording& r, const Moments& m);

struct Pictures {
  std::vector<std::string> png;  // in order
  std::string error;             // the reason if there are none, from the page
};

// Extracts the pictures from the text that the script has left in a page. Each must be a PNG of the requested size.
Pictures pictures(const std::string& dom, std::size_t first, std::size_t last, int width, int height);

// Width and height of a PNG; nullopt for other data.
std::optional<std::pair<int, int>> png_size(const std::string& bytes);

// Returns "frame-0001.png" for the first of `count` pictures.
std::string frame_name(std::size_t index, std::size_t count);

}  // namespace anholon::cli
