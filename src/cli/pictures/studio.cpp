#include "studio/studio.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include <spawn.h>

#include "api/pictures/sweep_cases.h"
#include "api/sweep_case.h"
#include "base/platform/installed.h"
#include "cli/input.h"
#include "cli/pictures/child.h"
#include "cli/pictures/sweep_page.h"
#include "cli/say.h"
#include "result/format.h"

extern char** environ;

namespace anholon::cli {

namespace {

// Opens the address in the user's browser, if there is a desktop, and does not wait for it.
void open_browser(const std::string& address) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  const std::string program = find_program({"xdg-open"});
  if (program.empty()) return;
  std::array<char*, 3> words = {const_cast<char*>(program.c_str()), const_cast<char*>(address.c_str()), nullptr};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int file : {0, 1, 2}) posix_spawn_file_actions_addopen(&files, file, "/dev/null", 2, 0);
  pid_t child = -1;
  if (posix_spawn(&child, words[0], &files, nullptr, words.data(), environ) != 0)
    say(stderr, "note: the browser could not be started\n");
  posix_spawn_file_actions_destroy(&files);
}

// Opens the folder of a sweep or the model that a name stands for. Throws UsageError.
void open(const std::string& name, StudioOptions& options) {
  std::error_code none;
  if (SweepStore::is_there(name)) {
    v1::opened_to_read(name);  // throws Failure if it cannot be read
    options.sweep = name;
    return;
  }
  if (std::filesystem::is_directory(name, none))
    throw UsageError{"error: the folder " + name + " holds no sweep\nhint: anholon sweep MODEL --vary … -o " + name +
                     "/ makes one; anholon studio mine.toml opens a model\n"};
  if (std::filesystem::is_regular_file(name, none) && v1::SweepCases::are_in(name))
    throw UsageError{
        "error: " + name +
        " holds the cases of a sweep and not their model, so the studio cannot compute their motions\nhint: "
        "a sweep in a folder keeps the model: anholon sweep MODEL --vary … -o falls/; the numbers alone: "
        "anholon plot " +
        name + " -o cases.html\n"};
  if (const ResultFormat* format = format_of(name); format && std::filesystem::is_regular_file(name, none))
    throw UsageError{"error: " + name + " is a file of results in " + format->name +
                     "\nhint: the studio opens a model, or a sweep in a folder\n"};
  options.source = model_text(name);
  options.shipped = options.source.path != "" || !std::filesystem::is_regular_file(name, none);
}

}  // namespace

int studio(const StudioCommand& o) {
  if (o.worker) {
    studio_work([](const std::string& folder) {
      PlotCommand map;
      map.run = folder;
      return map_of_sweep(map).data;
    });
    return kOk;
  }
  StudioOptions options;
  open(o.model.empty() ? "disc" : o.model, options);
  if (!has_studio())
    throw UsageError{"error: this program was built without the viewer, and so without the studio\nhint: ./dev build "
                     "builds it where there is npm\n"};
  options.port = o.port;
  options.worker = {own_file().string(), "studio", "--worker"};
  options.opened = [&](const std::string& address) {
    say(stdout, "%s\n", address.c_str());
    std::fflush(stdout);
    if (!o.quiet) say(stderr, "The studio is at this address until Ctrl-C. Whoever has the address can use it.\n");
    if (!o.no_browser) open_browser(address);
  };
  try {
    serve_studio(options);
  } catch (const std::runtime_error& e) {
    throw UsageError{std::string("error: ") + e.what() + "\nhint: --port 0 takes a free one\n"};
  }
  return kOk;
}

}  // namespace anholon::cli
