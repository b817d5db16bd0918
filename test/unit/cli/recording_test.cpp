#include <gtest/gtest.h>

#include "cli/input.h"
#include "cli/pictures/child.h"
#include "cli/pictures/recording.h"

namespace anholon::cli::recording_test {
namespace {

// A picture of 1 x 1 pixel, as a browser's toDataURL gives it.
constexpr const char* kPixel =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

RenderCommand asked(const std::string& output) {
  RenderCommand o;
  o.model = "models/disc.toml";
  o.output = output;
  return o;
}

std::string refused(const RenderCommand& o) {
  try {
    recording(o);
  } catch (const UsageError& e) {
    return e.text;
  }
  return "";
}

TEST(Pictures, OutOfAPage) {
  const std::string png = "data:image/png;base64," + std::string(kPixel);
  const std::string page =
      "<html><pre data-frame=\"7\">" + png + "</pre><pre data-frame=\"8\">" + png + "</pre></html>";
  const Pictures p = pictures(page, 7, 9, 1, 1);
  ASSERT_EQ(p.error, "");
  ASSERT_EQ(p.png.size(), 2U);
  EXPECT_EQ(p.png[0].substr(0, 8), std::string("\x89PNG\r\n\x1a\n", 8));
  EXPECT_EQ(p.png[0].substr(p.png[0].size() - 8, 4), "IEND");
  EXPECT_EQ(png_size(p.png[1]), (std::pair{1, 1}));
}

TEST(Pictures, WhatIsMissingOrDamagedIsNoticed) {
  const std::string png = "data:image/png;base64," + std::string(kPixel), line = "<pre data-frame=\"0\">";
  EXPECT_EQ(pictures("", 0, 1, 1, 1).error, "no picture");
  EXPECT_EQ(pictures(line + png, 0, 1, 1, 1).error, "no picture");  // the text is cut off
  EXPECT_EQ(pictures(line + "data:,</pre>", 0, 1, 1, 1).error, "a picture that is no PNG");
  EXPECT_EQ(pictures(line + png + "</pre>", 0, 1, 2, 1).error, "a picture of another size");
  EXPECT_EQ(pictures(line + png.substr(0, png.size() - 24) + "</pre>", 0, 1, 1, 1).error, "a picture that is damaged");
  EXPECT_EQ(pictures(line + png + "</pre>", 0, 2, 1, 1).error, "no picture");
  EXPECT_EQ(pictures("<pre data-error=\"\">no WebGL</pre>", 0, 1, 1, 1).error, "no WebGL");
}

TEST(Recording, KindByTheName) {
  EXPECT_EQ(recording(asked("a.mp4")).kind, Record::mp4);
  EXPECT_EQ(recording(asked("a.gif")).kind, Record::gif);
  EXPECT_EQ(recording(asked("a.png")).kind, Record::picture);
  EXPECT_EQ(recording(asked("frames/")).kind, Record::folder);
  EXPECT_EQ(recording(asked("")).output, "disc.mp4");
  RenderCommand at = asked("");
  at.at = "1";
  EXPECT_EQ(recording(at).output, "disc.png");
  EXPECT_NE(refused(asked("a.avi")).find("'a.avi'"), std::string::npos);
}

TEST(Recording, SizesAndRates) {
  const auto sized = [](const char* size, const char* output = "a.png") {
    RenderCommand o = asked(output);
    o.size = size;
    return o;
  };
  EXPECT_EQ(recording(sized("160x90")).width, 160);
  EXPECT_EQ(recording(sized("7680x7680")).height, 7680);
  EXPECT_EQ(recording(sized("161x91", "a.mp4")).width, 162);  // films have even sides
  EXPECT_EQ(recording(sized("161x91", "a.mp4")).height, 92);
  for (const char* wrong : {"160", "x", "160x", "63x90", "160x7681", "160x90x3", "-160x90", "1e3x900",
                            "99999999999999999999x90", "160 x 90"})
    EXPECT_NE(refused(sized(wrong)).find("--size"), std::string::npos) << wrong;
  for (const char* wrong : {"0", "-1", "121", "1e9"}) {
    RenderCommand o = asked("a.mp4");
    o.fps = wrong;
    EXPECT_NE(refused(o).find("--fps"), std::string::npos) << wrong;
  }
  RenderCommand o = asked("a.mp4");
  o.seconds = "0";
  EXPECT_NE(refused(o), "");
  o = asked("a.mp4"), o.at = "1";
  EXPECT_NE(refused(o), "");
  o = asked("a.png"), o.at = "60%";
  EXPECT_EQ(recording(o).part, 0.6);
  o.at = "101%";
  EXPECT_NE(refused(o), "");
  o = asked("a.png"), o.seconds = "1";
  EXPECT_NE(refused(o), "");
}

TEST(Recording, MomentsOfAMotion) {
  Recording r;
  r.kind = Record::mp4;
  EXPECT_EQ(moments(r, 0, 4).count, 120U);     // in real time
  EXPECT_EQ(moments(r, 0, 1).count, 300U);     // too short to be seen
  EXPECT_EQ(moments(r, 0, 1000).count, 300U);  // too long to be watched
  r.seconds = 0.01;
  EXPECT_EQ(moments(r, 0, 4).count, 2U);
  r.seconds = 2, r.from = 1, r.to = 3;
  const Moments m = moments(r, 0, 4);
  EXPECT_EQ(m.count, 60U);
  EXPECT_EQ(m.first, 1);
  EXPECT_EQ(m.last, 3);
  EXPECT_EQ(moments(r, 0, 2).last, 2);         // the motion stopped early
  EXPECT_THROW(moments(r, 5, 9), UsageError);  // --from is after the motion
  EXPECT_THROW(moments(r, 0, 1), UsageError);  // the interval holds none of the motion
  r.seconds = 1e6, r.to.reset();
  EXPECT_THROW(moments(r, 0, 4), UsageError);
  r.seconds.reset(), r.from.reset();
  EXPECT_EQ(moments(r, 3, -1).first, 3);  // the motion runs backwards
  EXPECT_EQ(moments(r, 3, -1).last, -1);
  r.kind = Record::picture;
  EXPECT_EQ(moments(r, 1, 4).first, 1);
  r.at = 2.5;
  EXPECT_EQ(moments(r, 1, 4).first, 2.5);
  EXPECT_EQ(moments(r, 1, 4).count, 1U);
  r.at.reset(), r.part = 0.25;
  EXPECT_EQ(moments(r, 1, 5).first, 2);
  r.part.reset();
  r.at = 4 + 1e-12;
  EXPECT_EQ(moments(r, 1, 4).first, 4);
  r.at = 4.1;
  EXPECT_THROW(moments(r, 1, 4), UsageError);
}

TEST(Recording, NamesOfFramesSortAsNumbers) {
  EXPECT_EQ(frame_name(0, 3), "frame-0001.png");
  EXPECT_EQ(frame_name(9998, 9999), "frame-9999.png");
  EXPECT_EQ(frame_name(0, 10000), "frame-00001.png");
  EXPECT_EQ(frame_name(9999, 10000), "frame-10000.png");
}

TEST(Child, OutputStatusAndEnds) {
  const auto never = [] { return false; };
  const Child said = run_child({"/bin/sh", "-c", "printf out; printf err >&2; exit 3"}, 60, never, 1000);
  EXPECT_EQ(said.end, Child::End::exited);
  EXPECT_EQ(said.status, 3);
  EXPECT_EQ(said.out, "out");
  EXPECT_EQ(said.err, "err");
  EXPECT_EQ(run_child({"/bin/sh", "-c", "kill -9 $$"}, 60, never, 1000).status, 137);
  EXPECT_EQ(run_child({"/nonexistent/program"}, 60, never, 1000).end, Child::End::not_started);
  EXPECT_EQ(run_child({"/bin/sh", "-c", "sleep 60"}, 0.2, never, 1000).end, Child::End::out_of_time);
  EXPECT_EQ(run_child({"/bin/sh", "-c", "sleep 60"}, 60, [] { return true; }, 1000).end, Child::End::stopped);
  EXPECT_EQ(run_child({"/bin/sh", "-c", "yes"}, 60, never, 1000).end, Child::End::too_much);
  // No shell reads the words, and no process waits for input.
  EXPECT_EQ(run_child({"/bin/echo", "$(id); *"}, 60, never, 1000).out, "$(id); *\n");
  EXPECT_EQ(run_child({"/bin/cat"}, 60, never, 1000).out, "");
}

TEST(Child, MuchOutputArrivesWhole) {
  const Child c = run_child({"/bin/sh", "-c", "head -c 3000000 /dev/zero"}, 60, nullptr, 10'000'000);
  EXPECT_EQ(c.out.size(), 3'000'000U);
}

TEST(Child, WhatItLeftBehindIsGone) {
  // The grandchild keeps the streams open; run_child does not wait for it.
  const Child c = run_child({"/bin/sh", "-c", "sleep 60 & echo $!"}, 60, nullptr, 1000);
  EXPECT_EQ(c.end, Child::End::exited);
  EXPECT_NE(c.out, "");
}

TEST(Child, Programs) {
  EXPECT_EQ(find_program({"/nonexistent/a", "/bin/sh"}), "/bin/sh");
  EXPECT_NE(find_program({"no-such-program-here", "sh"}), "");
  EXPECT_EQ(find_program({"no-such-program-here", "", "/"}), "");
}

TEST(TemporaryFolder, IsGoneAfterwards) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    EXPECT_TRUE(std::filesystem::is_directory(path));
    std::filesystem::create_directories(path / "a" / "b");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace anholon::cli::recording_test
