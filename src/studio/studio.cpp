#include "studio/studio.h"

#include <array>

#include "base/json.h"
#include "report/assets.h"
#include "studio/answers.h"
#include "studio/computing.h"
#include "studio/gate.h"
#include "studio/opened_file.h"

namespace anholon {

namespace {

constexpr std::array<Task, 4> kTasks = {{{"check", 5, true}, {"simulate", 30}, {"derive", 30}, {"prove", 60}}};
// The tasks of a sweep in a folder.
constexpr Task kMap = {"sweep", 60, true}, kCase = {"case", 30};

// Returns a page that loads these scripts; `opens`, "model" or "sweep", tells the last script what to show.
std::string page(const std::string& opens, const std::vector<std::string>& scripts) {
  std::string text = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                     "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                     "<meta name=\"color-scheme\" content=\"light dark\">\n<title>Anholon studio</title>\n"
                     "<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"studio.css\">\n";
  for (const std::string& name : scripts) text += "<script defer src=\"" + name + "\"></script>\n";
  return text + "</head>\n<body data-opens=\"" + opens +
         "\"><noscript>The studio needs a browser that runs the scripts of this page.</noscript></body>\n</html>\n";
}

HttpReply no_such_page() { return {404, "text/plain; charset=utf-8", "there is no such page\n"}; }

// Returns a file that belongs to every page of the studio.
HttpReply file(const std::string& name) {
  if (name == "studio.js") return {200, "text/javascript; charset=utf-8", std::string(studio_script())};
  if (name == "map.js") return {200, "text/javascript; charset=utf-8", std::string(map_script())};
  if (name == "studio.css")
    return {200, "text/css; charset=utf-8",
            std::string(page_style()) + std::string(map_style()) + std::string(studio_style())};
  return no_such_page();
}

// The pages of the server: of a model, or of a sweep.
class Pages {
 public:
  Pages() = default;
  virtual ~Pages() = default;
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  virtual HttpReply handle(const std::string& what, const HttpRequest& request) = 0;
  virtual void stop() = 0;
};

class ModelPages final : public Pages {
 public:
  explicit ModelPages(const StudioOptions& o) : file_(o.source, o.shipped), computing_(o.worker) {}

  HttpReply handle(const std::string& what, const HttpRequest& request) override {
    if (request.head.method == "GET") {
      if (what.empty()) return {200, "text/html; charset=utf-8", page("model", {"studio.js"})};
      if (what == "language") return json_reply(language_json());
      if (what == "model") return json_reply(model());
      return file(what);
    }
    if (what == "save" || what == "save-anyway") return save(request, what == "save-anyway");
    const SourceText& s = file_.source();
    for (const Task& t : kTasks)
      if (what == t.name)
        return computing_.answer(t, request,
                                 {t.name, s.name, s.path, request.case_name, request.body, file_.readable()});
    return no_such_page();
  }
  void stop() override { computing_.stop(); }

 private:
  std::string model() {
    const OpenedFile::Text now = file_.text();
    JsonWriter json;
    json.open_object().key("name").string(file_.source().name).key("text").string(now.text);
    json.key("hash").string(now.hash);
    json.key("no_saving").string(file_.no_saving()).key("version").string("anholon " ANHOLON_VERSION);
    return json.close().text();
  }

  HttpReply save(const HttpRequest& request, bool anyway) {
    const OpenedFile::Saving s = file_.save(request.body, request.known, anyway);
    if (s.how == OpenedFile::Saved::saved) return json_reply("{\"saved\": true, \"hash\": \"" + s.hash + "\"}");
    return json_reply(trouble(s.why, ""), s.how == OpenedFile::Saved::failed ? 403 : 409);
  }

  OpenedFile file_;
  Computing computing_;
};

class SweepPages final : public Pages {
 public:
  explicit SweepPages(const StudioOptions& o) : folder_(o.sweep), computing_(o.worker) {}

  HttpReply handle(const std::string& what, const HttpRequest& request) override {
    if (request.head.method == "GET") {
      if (what.empty()) return {200, "text/html; charset=utf-8", page("sweep", {"map.js", "studio.js"})};
      if (what == kMap.name) return computing_.answer(kMap, {kMap.name, folder_, folder_, {}, {}, {}});
      return file(what);
    }
    if (what == kCase.name)
      return computing_.answer(kCase, request, {kCase.name, folder_, folder_, {}, request.body, {}});
    return no_such_page();
  }
  void stop() override { computing_.stop(); }

 private:
  std::string folder_;
  Computing computing_;
};

}  // namespace

void serve_studio(const StudioOptions& options) {
  HttpServer server(options.port, {});
  const Gate gate(random_token(), server.port());
  const std::unique_ptr<Pages> pages = options.sweep.empty()
                                           ? std::unique_ptr<Pages>(std::make_unique<ModelPages>(options))
                                           : std::make_unique<SweepPages>(options);
  options.opened(gate.address());
  server.run([&](const HttpHead& head) { return gate.refuse(head); },
             [&](const HttpRequest& request) { return pages->handle(gate.behind_token(request.head), request); },
             [&] { pages->stop(); });
}

void studio_work(MapOfSweep map) {
  Answers answers;
  const CaseAnswers cases(std::move(map));
  work({}, [&](const Question& q) { return CaseAnswers::knows(q) ? cases.answer(q) : answers.answer(q); });
}

bool has_studio() { return !studio_script().empty(); }

}  // namespace anholon
