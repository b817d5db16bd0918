#include "studio/studio.h"

#include <array>
#include <atomic>
#include <charconv>
#include <map>
#include <mutex>

#include "base/json.h"
#include "report/assets.h"
#include "studio/answers.h"
#include "studio/gate.h"
#include "studio/opened_file.h"
#include "studio/worker.h"

namespace anholon {

namespace {

// What may be asked, and for how long.
struct Task {
  const char* name;
  double seconds;
};
constexpr std::array<Task, 4> kTasks = {{{"check", 5}, {"simulate", 30}, {"derive", 30}, {"prove", 60}}};

constexpr const char* kPage =
    "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
    "<meta name=\"color-scheme\" content=\"light dark\">\n<title>Anholon studio</title>\n"
    "<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"studio.css\">\n"
    "<script defer src=\"studio.js\"></script>\n</head>\n"
    "<body><noscript>The studio needs a browser that runs the scripts of this page.</noscript></body>\n</html>\n";

HttpReply json_reply(std::string body, int status = 200) {
  return {status, "application/json; charset=utf-8", std::move(body)};
}

std::string trouble(const std::string& text, const std::string& hint) {
  JsonWriter json;
  json.open_object().key("error").open_object().key("text").string(text).key("hint").string(hint);
  json.key("outcome").string("").key("diagnostics").open_array().close().close();
  return json.close().text();
}

// The newest edition of each page of a browser: a computation of an older text is given up.
class Editions {
 public:
  // Returns the worker of the edition, 0 or 1. A new edition gets the other one: it need not wait until the process of
  // the older text is replaced.
  std::size_t seen(const std::string& page, unsigned long long edition) {
    const std::lock_guard<std::mutex> lock(turn_);
    if (newest_.size() > kMostPages) newest_.clear();
    Newest& n = newest_[page.substr(0, 64)];
    if (edition > n.edition) n = {edition, 1 - n.worker};
    return n.worker;
  }
  bool is_old(const std::string& page, unsigned long long edition) {
    const std::lock_guard<std::mutex> lock(turn_);
    const auto it = newest_.find(page.substr(0, 64));
    return it != newest_.end() && it->second.edition > edition;
  }

 private:
  static constexpr std::size_t kMostPages = 1000;
  std::mutex turn_;
  struct Newest {
    unsigned long long edition = 0;
    std::size_t worker = 0;
  };
  std::map<std::string, Newest> newest_;
};

class Studio {
 public:
  explicit Studio(const StudioOptions& o)
      : file_(o.source, o.shipped), checker_(o.worker), movers_{Worker(o.worker), Worker(o.worker)} {}

  HttpReply handle(const std::string& what, const HttpRequest& request) {
    if (request.head.method == "GET") {
      if (what.empty()) return {200, "text/html; charset=utf-8", kPage};
      if (what == "studio.js") return {200, "text/javascript; charset=utf-8", std::string(studio_script())};
      if (what == "studio.css")
        return {200, "text/css; charset=utf-8", std::string(page_style()) + std::string(studio_style())};
      if (what == "language") return json_reply(language_json());
      if (what == "model") return json_reply(model());
    } else {
      if (what == "save" || what == "save-anyway") return save(request.body, what == "save-anyway");
      for (const Task& t : kTasks)
        if (what == t.name) return compute(t, request);
    }
    return {404, "text/plain; charset=utf-8", "there is no such page\n"};
  }
  void stop() { stopping_ = true; }

 private:
  std::string model() const {
    const SourceText& s = file_.source();
    JsonWriter json;
    json.open_object().key("name").string(s.name).key("text").string(s.text);
    json.key("no_saving").string(file_.no_saving()).key("version").string("anholon " ANHOLON_VERSION);
    return json.close().text();
  }

  HttpReply save(const std::string& text, bool anyway) {
    const OpenedFile::Saving s = file_.save(text, anyway);
    if (s.how == OpenedFile::Saved::saved) return json_reply("{\"saved\": true}");
    return json_reply(trouble(s.why, ""), s.how == OpenedFile::Saved::failed ? 403 : 409);
  }

  HttpReply compute(const Task& task, const HttpRequest& request) {
    unsigned long long edition = 0;
    const char* end = request.edition.data() + request.edition.size();
    if (std::from_chars(request.edition.data(), end, edition).ptr != end || request.edition.empty())
      return {400, "text/plain; charset=utf-8", "X-Anholon-Edition is the number of the text's edition\n"};
    const std::size_t of_edition = editions_.seen(request.page, edition);
    const auto give_up = [&] { return stopping_ || editions_.is_old(request.page, edition); };
    const SourceText& s = file_.source();
    const Question q{task.name, s.name, s.path, request.case_name, request.body, file_.readable()};
    Worker& worker = std::string(task.name) == "check" ? checker_ : movers_[of_edition];
    const Worker::Answer a = worker.ask(q, task.seconds, give_up);
    switch (a.end) {
    case Worker::End::answered:
      return json_reply(a.text);
    case Worker::End::given_up:
      return json_reply("{\"replaced\": true}");
    case Worker::End::out_of_time:
      return json_reply(trouble("stopped after " + std::to_string(static_cast<int>(task.seconds)) +
                                    " s: the studio gives no computation more time",
                                "the command line has no such limit"));
    case Worker::End::died:
      return json_reply(trouble("the computation ended without a result, for want of memory or by a fault",
                                "the terminal of 'anholon studio' says more"));
    }
    return {500, "text/plain; charset=utf-8", ""};
  }

  OpenedFile file_;
  Worker checker_;
  std::array<Worker, 2> movers_;
  Editions editions_;
  std::atomic<bool> stopping_{false};
};

}  // namespace

void serve_studio(const StudioOptions& options) {
  HttpServer server(options.port, {});
  const Gate gate(random_token(), server.port());
  Studio studio(options);
  options.opened(gate.address());
  server.run([&](const HttpHead& head) { return gate.refuse(head); },
             [&](const HttpRequest& request) { return studio.handle(gate.behind_token(request.head), request); },
             [&] { studio.stop(); });
}

void studio_work() {
  Answers answers;
  work({}, [&](const Question& q) { return answers.answer(q); });
}

bool has_studio() { return !studio_script().empty(); }

}  // namespace anholon
