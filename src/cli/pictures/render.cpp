#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>

#include <unistd.h>

#include "base/json.h"
#include "cli/motions/progress.h"
#include "cli/motions/report.h"
#include "cli/pictures/child.h"
#include "cli/pictures/recording.h"
#include "cli/say.h"
#include "cli/stop.h"
#include "numeric/number.h"
#include "report/assets.h"
#include "report/page/page.h"
#include "result/file.h"

namespace anholon::cli {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& what, const std::string& hint) {
  throw UsageError{"error: " + what + (hint.empty() ? "" : "\nhint: " + hint) + "\n"};
}

struct Stopped {};

// Returns the last lines of a program's messages.
std::string said(const std::string& err) {
  std::size_t at = err.find_last_not_of("\n\r ");
  if (at == std::string::npos) return "it said nothing";
  const std::string text = err.substr(0, at + 1);
  constexpr int kLines = 5;
  at = text.size();
  for (int k = 0; k < kLines && at != std::string::npos && at > 0; ++k) at = text.rfind('\n', at - 1);
  return "it said:\n" + (at == std::string::npos || at == 0 ? text : text.substr(at + 1));
}

std::string browser() {
  const char* own = std::getenv("ANHOLON_CHROMIUM");
  if (own && *own) {
    const std::string found = find_program({own});
    if (found.empty())
      refuse("ANHOLON_CHROMIUM names no program: '" + std::string(own) + "'", "the path of Chromium or Chrome");
    return found;
  }
  const std::string found = find_program({"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"});
  if (found.empty())
    refuse("pictures are drawn by Chromium, which is not installed",
           "apt-get install chromium, or ANHOLON_CHROMIUM=/path/of/chrome; the page that `anholon report` makes needs "
           "no more than any browser");
  return found;
}

std::string film_maker(const Recording& r) {
  if (r.kind != Record::mp4 && r.kind != Record::gif) return "";
  const std::string found = find_program({"ffmpeg"});
  if (found.empty())
    refuse("films are made by ffmpeg, which is not installed",
           "apt-get install ffmpeg, or -o frames/ for a picture of each moment");
  return found;
}

// Checks the output before anything is computed.
void check_place(const Recording& r) {
  if (r.kind == Record::folder) {
    std::error_code error;
    fs::create_directories(r.output, error);
    if (error) refuse("cannot write " + r.output + ": " + error.message(), "");
    if (access(r.output.c_str(), W_OK) != 0) refuse("cannot write " + r.output + ": " + std::strerror(errno), "");
    return;
  }
  if (const std::string why = obstacle_to_writing(r.output); !why.empty()) refuse(why, "");
}

// Reads or computes the motion and its model.
int motion(const RenderCommand& o, Told& x) {
  if (!o.rows.empty() || is_a_run(o.model)) {
    take_up(o, o.rows, x);
    return kOk;
  }
  SimulateCommand one{o, {}, {}, {}, {}};
  one.motion.error_estimate = "never";  // the estimate is not printed
  return simulate_motion(one, nullptr, &x);
}

// One recording of one page: the browser is started for a limited number of pictures at a time, to bound its memory.
class Browser {
 public:
  Browser(const Recording& r, const fs::path& folder, std::string program)
      : r_(r), page_(folder / "page.html"), profile_(folder / "profile"), program_(std::move(program)) {}

  std::vector<std::string> pictures(std::size_t first, std::size_t last) const {
    const double pixels = static_cast<double>(r_.width) * r_.height * static_cast<double>(last - first);
    // An upper bound for a working machine, including start-up and the slowest software renderer.
    const double limit = 120 + 60 * static_cast<double>(last - first) + pixels / 1e5;
    const Child c =
        run_child(arguments(first, last), limit, stop_requested, static_cast<std::size_t>(8 * pixels) + 10'000'000);
    switch (c.end) {
    case Child::End::stopped:
      throw Stopped();
    case Child::End::not_started:
      refuse(program_ + " cannot be started: " + std::strerror(c.status), "");
    case Child::End::out_of_time:
      refuse("Chromium did not finish " + std::to_string(last - first) + " pictures within " + number_of(limit) + " s",
             "a smaller --size");
    case Child::End::too_much:
      refuse("Chromium printed more than pictures", "");
    case Child::End::exited:
      break;
    }
    Pictures p = cli::pictures(c.out, first, last, r_.width, r_.height);
    if (p.error.empty()) return std::move(p.png);
    if (p.error == "no WebGL")
      refuse("this Chromium has no WebGL, which the picture needs",
             "Chromium 100 or later with SwiftShader (Debian: chromium-common)");
    if (p.error == "no scene") refuse("this model has nothing to draw", "bodies or particles with positions");
    if (!c.out.empty() && c.status == 0) refuse("the recording failed: " + p.error, "");
    refuse("Chromium (" + program_ + ") made no picture, exit status " + std::to_string(c.status) + "; " + said(c.err),
           "one installed as a snap sees no temporary files: TMPDIR=$HOME, or ANHOLON_CHROMIUM=/path/of/another");
  }

 private:
  static std::string number_of(double x) { return std::to_string(static_cast<long>(x)); }

  std::vector<std::string> arguments(std::size_t first, std::size_t last) const {
    std::vector<std::string> a = {program_,
                                  "--headless=new",
                                  "--use-angle=swiftshader",
                                  "--enable-unsafe-swiftshader",
                                  "--disable-gpu-compositing",
                                  "--disable-accelerated-2d-canvas",
                                  "--disable-background-networking",
                                  "--disable-component-update",
                                  "--disable-breakpad",
                                  "--disable-dev-shm-usage",
                                  "--disable-extensions",
                                  "--disable-sync",
                                  "--hide-scrollbars",
                                  "--mute-audio",
                                  "--no-first-run",
                                  "--no-default-browser-check",
                                  "--force-device-scale-factor=1",
                                  "--force-color-profile=srgb",
                                  "--user-data-dir=" + profile_.string()};
    if (geteuid() == 0) a.emplace_back("--no-sandbox");  // the sandbox does not start for root
    a.push_back("--window-size=" + std::to_string(std::min(r_.width, 1920)) + "," +
                std::to_string(std::min(r_.height, 1080)));
    a.emplace_back("--dump-dom");
    std::string address = "file://";
    for (const char c : fs::absolute(page_).string()) {
      if (std::isalnum(static_cast<unsigned char>(c)) || std::strchr("/-_.~", c)) {
        address += c;
      } else {
        char code[4];
        std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(c));
        address += code;
      }
    }
    a.push_back(address + "#" + std::to_string(first) + "-" + std::to_string(last));
    return a;
  }

  const Recording& r_;
  fs::path page_, profile_;
  std::string program_;
};

void write_picture(const fs::path& path, const std::string& png) {
  if (const std::string why = write_whole(path.string(), png); !why.empty()) refuse(why, "");
}

// Records all pictures into the folder, in batches of some seconds.
void record(const Browser& browser, const Recording& r, const Moments& m, const fs::path& into, bool quiet) {
  using Clock = std::chrono::steady_clock;
  constexpr double kSeconds = 8, kMostPixels = 1.2e8;
  const auto most = static_cast<std::size_t>(std::max(1.0, kMostPixels / r.width / r.height));
  Progress progress(quiet, "picture", "pictures");
  std::size_t batch = std::min<std::size_t>(4, most);
  for (std::size_t first = 0; first < m.count;) {
    const std::size_t last = std::min(m.count, first + batch);
    const auto start = Clock::now();
    const std::vector<std::string> png = browser.pictures(first, last);
    for (std::size_t k = first; k < last; ++k) write_picture(into / frame_name(k, m.count), png[k - first]);
    const double each = std::chrono::duration<double>(Clock::now() - start).count() / static_cast<double>(last - first);
    batch = std::clamp<std::size_t>(static_cast<std::size_t>(kSeconds / std::max(each, 1e-3)), 1, most);
    batch = std::max(batch, std::min<std::size_t>(8, most));
    first = last;
    progress(static_cast<double>(last) / static_cast<double>(m.count), static_cast<double>(last), last);
    if (stop_requested()) throw Stopped();
  }
}

std::string text_of(double fps) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", fps);
  return text;
}

void make_film(const std::string& ffmpeg, const Recording& r, const Moments& m, const fs::path& frames) {
  const std::string digits = std::to_string(frame_name(0, m.count).size() - std::strlen("frame-.png"));
  const std::string beside = r.output + ".part";
  const std::vector<std::string> begin = {
      ffmpeg, "-hide_banner", "-loglevel",    "error", "-nostdin",
      "-y",   "-framerate",   text_of(r.fps), "-i",    (frames / ("frame-%0" + digits + "d.png")).string()};
  const auto run = [&](const std::vector<std::string>& rest) {
    std::vector<std::string> a = begin;
    a.insert(a.end(), rest.begin(), rest.end());
    // The prefix "file:" prevents a name from being taken for an option or a protocol.
    a.push_back("file:" + beside);
    const double limit = 600 + static_cast<double>(m.count) * r.width * r.height / 2e5;
    return run_child(a, limit, stop_requested, 1'000'000);
  };
  std::vector<std::vector<std::string>> ways;
  if (r.kind == Record::gif) {
    // Uses one palette for the whole film, and redraws only changed parts.
    ways = {
        {"-filter_complex",
         "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=bayer:bayer_scale=5:diff_mode=rectangle",
         "-loop", "0", "-f", "gif"}};
  } else {
    const std::vector<std::string> end = {"-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"};
    ways = {{"-c:v", "libx264", "-preset", "medium", "-crf", "18"}, {"-c:v", "mpeg4", "-q:v", "3"}};
    for (auto& w : ways) w.insert(w.end(), end.begin(), end.end());
  }
  Child c;
  for (const auto& way : ways) {
    c = run(way);
    if (c.ok() || c.end == Child::End::stopped || c.err.find("Unknown encoder") == std::string::npos) break;
  }
  if (c.ok() && std::rename(beside.c_str(), r.output.c_str()) == 0) return;
  const std::string why = c.ok() ? std::strerror(errno) : "";
  std::remove(beside.c_str());
  if (c.end == Child::End::stopped) throw Stopped();
  if (!why.empty()) refuse("cannot write " + r.output + ": " + why, "");
  refuse("ffmpeg failed, " + (c.end == Child::End::out_of_time
                                  ? std::string("it did not finish")
                                  : "exit status " + std::to_string(c.status) + "; " + said(c.err)),
         "-o frames/ for a picture of each moment");
}

// Reports pictures of a longer recording in the same folder.
void note_others(const Recording& r, const Moments& m) {
  std::size_t others = 0;
  std::error_code error;
  for (const auto& f : fs::directory_iterator(r.output, error)) {
    const std::string name = f.path().filename().string();
    if (name.rfind("frame-", 0) == 0 &&
        (name.size() != frame_name(0, m.count).size() || name > frame_name(m.count - 1, m.count)))
      ++others;
  }
  if (others) say(stderr, "note: %s holds %zu more pictures, of a recording before\n", r.output.c_str(), others);
}

}  // namespace

int render(const RenderCommand& o) {
  const Recording r = recording(o);
  if (viewer_script().empty())
    refuse("this program was built without the viewer, which draws the pictures",
           "./dev build, which makes the viewer where there is npm");
  const std::string chromium = browser(), ffmpeg = film_maker(r);
  check_place(r);
  catch_stop(o.output.empty() ? o.model : o.output);

  std::deque<Told> cases(1);
  Told& x = cases[0];
  const int code = motion(o, x);
  const RunTable& table = x.run.table;
  const std::size_t time = table.find("t");
  if (table.rows() == 0 || stop_requested()) return code == kOk ? kStopped : code;
  if (time == table.columns.size()) refuse("the run has no column t", "");
  if (!o.frame.empty() && x.in.model->observer.inertial)
    say(stderr, "note: the observer of this model is an inertial one; --frame makes no difference\n");
  const Moments m = moments(r, table.values[time].front(), table.values[time].back());

  Page page;
  page.cases.push_back({x.name, x.scenario.get(), {}, {}, std::move(x.run)});
  page.version = "anholon " ANHOLON_VERSION;
  page.source = x.in.source;
  try {
    const TemporaryFolder folder;
    if (const std::string why =
            write_whole((folder.path() / "page.html").string(), stage_html(page, r.dark, record_script(r, m)));
        !why.empty())
      refuse(why, "TMPDIR names the place for temporary files");
    const Browser b(r, folder.path(), chromium);
    const auto start = std::chrono::steady_clock::now();
    switch (r.kind) {
    case Record::picture:
      write_picture(r.output, b.pictures(0, 1)[0]);
      break;
    case Record::folder:
      record(b, r, m, r.output, o.quiet);
      note_others(r, m);
      break;
    case Record::mp4:
    case Record::gif:
      record(b, r, m, folder.path(), o.quiet);
      make_film(ffmpeg, r, m, folder.path());
      break;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (o.json) {
      JsonWriter j;
      j.open_object()
          .key("output")
          .string(r.output)
          .key("width")
          .integer(r.width)
          .key("height")
          .integer(r.height)
          .key("pictures")
          .integer(static_cast<long long>(m.count));
      j.key("first")
          .number(number_text(m.first))
          .key("last")
          .number(number_text(m.last))
          .key("seconds")
          .number(text_of(seconds))
          .close();
      hand_out(j.text() + "\n");
    }
    if (!o.quiet) {
      say(stderr, "recorded: %s, %dx%d, %zu picture%s in %.1f s\n", r.output.c_str(), r.width, r.height, m.count,
          m.count == 1 ? "" : "s", seconds);
    }
  } catch (const Stopped&) {
    say_lines(stderr, "stopped: nothing more is recorded\n");
    return kStopped;
  }
  return code;
}

}  // namespace anholon::cli
