#include "cli/pictures/recording.h"

#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/base64.h"
#include "cli/input.h"
#include "numeric/number.h"

namespace anholon::cli {

namespace {

constexpr int kLeastSize = 64, kMostSize = 7680;
constexpr double kLeastFps = 1, kMostFps = 120;
constexpr std::size_t kMostPictures = 20000;
// A motion of a duration between these bounds is shown in real time.
constexpr double kShortest = 2, kLongest = 20, kUsual = 10;

double number(const std::string& text, const char* option) { return exact(text, option).get_d(); }

Record kind_of(const std::string& path) {
  const std::filesystem::path p(path);
  std::error_code none;
  if (path.back() == '/' || std::filesystem::is_directory(p, none)) return Record::folder;
  const std::string end = p.extension().string();
  for (const auto& [name, kind] : {std::pair{".mp4", Record::mp4}, {".gif", Record::gif}, {".png", Record::picture}})
    if (end == name) return kind;
  throw UsageError{"error: a recording '" + path +
                   "' cannot be made\nhint: FILE.mp4 or FILE.gif for a film, FILE.png for one picture, FOLDER/ for a "
                   "picture of each moment\n"};
}

void take_size(const std::string& text, Recording& r) {
  const auto wrong = [&](const std::string& what) {
    throw UsageError{"error: --size " + text + ": " + what + "\nhint: --size 1280x720, in pixels\n"};
  };
  const std::size_t x = text.find('x');
  if (x == std::string::npos) wrong("not of the form WIDTHxHEIGHT");
  const auto whole = [&](const std::string& part) {
    int n = 0;
    const auto end = part.data() + part.size();
    const auto got = std::from_chars(part.data(), end, n);
    if (part.empty() || got.ptr != end || (got.ec != std::errc() && got.ec != std::errc::result_out_of_range))
      wrong("not two whole numbers");
    return got.ec == std::errc() ? n : kMostSize + 1;
  };
  r.width = whole(text.substr(0, x)), r.height = whole(text.substr(x + 1));
  if (r.width < kLeastSize || r.width > kMostSize || r.height < kLeastSize || r.height > kMostSize)
    wrong("from " + std::to_string(kLeastSize) + "x" + std::to_string(kLeastSize) + " to " + std::to_string(kMostSize) +
          "x" + std::to_string(kMostSize));
}

}  // namespace

Recording recording(const RenderCommand& o) {
  Recording r;
  r.output =
      o.output.empty() ? std::filesystem::path(o.model).stem().string() + (o.at.empty() ? ".mp4" : ".png") : o.output;
  r.kind = kind_of(r.output);
  if (r.kind == Record::gif) r.width = 640, r.height = 360, r.fps = 25;
  if (!o.size.empty()) take_size(o.size, r);
  // With half the colour resolution, two by two pixels of a film share a colour, so the sides are even.
  if (r.kind == Record::mp4) r.width += r.width % 2, r.height += r.height % 2;
  if (!o.fps.empty()) r.fps = number(o.fps, "--fps");
  if (!(r.fps >= kLeastFps && r.fps <= kMostFps))
    throw UsageError{"error: --fps " + o.fps + ": from " + number_text(kLeastFps) + " to " + number_text(kMostFps) +
                     " pictures per second\n"};
  if (!o.seconds.empty()) r.seconds = number(o.seconds, "--seconds");
  if (r.seconds && !(*r.seconds > 0)) throw UsageError{"error: --seconds " + o.seconds + ": a film lasts a while\n"};
  if (o.at.ends_with('%')) {
    r.part = number(o.at.substr(0, o.at.size() - 1), "--at") / 100;
    if (!(*r.part >= 0 && *r.part <= 1)) throw UsageError{"error: --at " + o.at + ": from 0% to 100% of the motion\n"};
  } else if (!o.at.empty()) {
    r.at = number(o.at, "--at");
  }
  if (!o.from.empty()) r.from = number(o.from, "--from");
  if (o.motion.to) r.to = o.motion.to->get_d();
  if ((r.at || r.part) && r.kind != Record::picture)
    throw UsageError{"error: --at is the time of one picture\nhint: -o FILE.png, or --from and --to for a film\n"};
  if (r.kind == Record::picture && (!o.seconds.empty() || !o.fps.empty()))
    throw UsageError{"error: one picture has no " + std::string(o.fps.empty() ? "--seconds" : "--fps") +
                     "\nhint: --at for its time, or -o FOLDER/ for many\n"};
  if (!o.frame.empty()) r.frame = o.frame;
  r.dark = o.dark;
  return r;
}

Moments moments(const Recording& r, double start, double end) {
  const double least = std::min(start, end), most = std::max(start, end);
  const std::string range = "from t = " + number_text(start, 10) + " to " + number_text(end, 10);
  const auto inside = [&](double t, const char* option) {
    // A time written in decimals may differ from the double of the end by rounding.
    const double slack = 1e-9 * std::max({std::abs(least), std::abs(most), most - least});
    if (t < least - slack || t > most + slack)
      throw UsageError{"error: " + std::string(option) + " " + number_text(t, 10) + " lies outside the motion, " +
                       range + "\n"};
    return std::clamp(t, least, most);
  };
  Moments m;
  m.fps = r.fps;
  if (r.kind == Record::picture) {
    m.first = m.last = r.at     ? inside(*r.at, "--at")
                       : r.part ? start + *r.part * (end - start)
                       : r.from ? inside(*r.from, "--from")
                                : start;
    return m;
  }
  m.first = r.from ? inside(*r.from, "--from") : start;
  m.last = r.to ? std::clamp(*r.to, least, most) : end;  // a motion that stopped early is recorded up to its end
  if (m.first == m.last)
    throw UsageError{"error: there is nothing to record between t = " + number_text(m.first, 10) + " and " +
                     number_text(m.last, 10) + "; the motion goes " + range + "\n"};
  const double lasts = std::abs(m.last - m.first);
  const double seconds = r.seconds.value_or(lasts >= kShortest && lasts <= kLongest ? lasts : kUsual);
  const double count = std::round(seconds * r.fps);
  if (count > static_cast<double>(kMostPictures))
    throw UsageError{"error: " + number_text(seconds) + " s at " + number_text(r.fps) +
                     " pictures per second are more than " + std::to_string(kMostPictures) +
                     " pictures\nhint: fewer with --seconds or --fps\n"};
  m.count = std::max<std::size_t>(2, static_cast<std::size_t>(count));
  return m;
}

std::string record_script(const Recording& r, const Moments& m) {
  std::string out = "const asked = {first: " + number_text(m.first) + ", last: " + number_text(m.last) +
                    ", count: " + std::to_string(m.count) + ", width: " + std::to_string(r.width) +
                    ", height: " + std::to_string(r.height) + ", frame: \"" + r.frame + "\"};\n";
  // All pictures are drawn before the page counts as loaded: a browser that prints its text then includes them.
  out += R"(
function record() {
  const [a, b] = location.hash.slice(1).split('-').map(Number), {anholon} = window;
  const motion = anholon.cases[0];
  anholon.stage(asked.width, asked.height, asked.frame);
  const view = document.querySelector('.anholon-stage canvas');
  if (!view) throw new Error(document.querySelector('.player .sorry') ? 'no WebGL' : anholon.errors[0] || 'no scene');
  const picture = document.createElement('canvas'), out = [];
  picture.width = asked.width;
  picture.height = asked.height;
  const pen = picture.getContext('2d', {willReadFrequently: true});
  pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--panel').trim() || '#fff';
  for (let k = a; k < b; ++k) {
    motion.seek(asked.first + (asked.last - asked.first) * (asked.count > 1 ? k / (asked.count - 1) : 0));
    pen.fillRect(0, 0, picture.width, picture.height);
    pen.drawImage(view, 0, 0, picture.width, picture.height);
    out.push([k, picture.toDataURL('image/png')]);
  }
  return out;
}
addEventListener('DOMContentLoaded', () => {
  const lines = [];
  const leave = (name, value, text) => {
    const line = document.createElement('pre');
    line.setAttribute('data-' + name, value);
    line.textContent = text;
    lines.push(line);
  };
  try {
    for (const [k, text] of record()) leave('frame', k, text);
  } catch (e) {
    leave('error', '', e.message);
  }
  document.documentElement.replaceChildren(...lines);
});
)";
  return out;
}

Pictures pictures(const std::string& dom, std::size_t first, std::size_t last, int width, int height) {
  Pictures p;
  const std::string_view all = dom;
  const auto text_after = [&](const std::string& mark) -> std::optional<std::string_view> {
    const std::size_t at = all.find(mark);
    if (at == std::string_view::npos) return std::nullopt;
    const std::size_t begin = at + mark.size(), end = all.find('<', begin);
    if (end == std::string_view::npos) return std::nullopt;
    return all.substr(begin, end - begin);
  };
  if (const auto error = text_after("<pre data-error=\"\">")) {
    p.error = *error;
    return p;
  }
  constexpr std::string_view kPng = "data:image/png;base64,";
  for (std::size_t k = first; k < last; ++k) {
    auto text = text_after("<pre data-frame=\"" + std::to_string(k) + "\">");
    if (!text || text->substr(0, kPng.size()) != kPng) {
      p.error = text ? "a picture that is no PNG" : "no picture";
      return p;
    }
    text->remove_prefix(kPng.size());
    p.png.push_back(from_base64(*text));
    const auto size = png_size(p.png.back());
    if (!size || *size != std::pair{width, height}) {
      p.error = size ? "a picture of another size" : "a picture that is damaged";
      return p;
    }
  }
  return p;
}

std::optional<std::pair<int, int>> png_size(const std::string& bytes) {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  constexpr std::size_t kSize = 16;  // signature, length and name of the first chunk
  if (bytes.size() < kSize + 8 || std::string_view(bytes).substr(0, 8) != kSignature || bytes.substr(12, 4) != "IHDR")
    return std::nullopt;
  // A truncated file is not a picture: the last chunk is missing then.
  if (bytes.find("IEND", bytes.size() - 12) == std::string::npos) return std::nullopt;
  const auto at = [&](std::size_t from) {
    int n = 0;
    for (std::size_t k = 0; k < 4; ++k) n = n << 8 | static_cast<unsigned char>(bytes[from + k]);
    return n;
  };
  return std::pair{at(kSize), at(kSize + 4)};
}

std::string frame_name(std::size_t index, std::size_t count) {
  const std::string number = std::to_string(index + 1);
  const std::size_t digits = std::max<std::size_t>(4, std::to_string(count).size());
  return "frame-" + std::string(digits - std::min(digits, number.size()), '0') + number + ".png";
}

}  // namespace anholon::cli
