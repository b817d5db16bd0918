#include "studio/computing.h"

#include <charconv>

#include "base/json.h"

namespace anholon {

HttpReply json_reply(std::string body, int status) {
  return {status, "application/json; charset=utf-8", std::move(body)};
}

std::string trouble(const std::string& text, const std::string& hint) {
  JsonWriter json;
  json.open_object().key("error").open_object().key("text").string(text).key("hint").string(hint);
  json.key("outcome").string("").key("diagnostics").open_array().close().close();
  return json.close().text();
}

std::size_t Editions::seen(const std::string& page, unsigned long long edition) {
  const std::lock_guard<std::mutex> lock(turn_);
  if (newest_.size() > kMostPages) newest_.clear();
  Newest& n = newest_[page.substr(0, 64)];
  if (edition > n.edition) n = {edition, 1 - n.worker};
  return n.worker;
}

bool Editions::is_old(const std::string& page, unsigned long long edition) {
  const std::lock_guard<std::mutex> lock(turn_);
  const auto it = newest_.find(page.substr(0, 64));
  return it != newest_.end() && it->second.edition > edition;
}

HttpReply Computing::answer(const Task& task, const HttpRequest& request, const Question& question) {
  unsigned long long edition = 0;
  const char* end = request.edition.data() + request.edition.size();
  if (std::from_chars(request.edition.data(), end, edition).ptr != end || request.edition.empty())
    return {400, "text/plain; charset=utf-8", "X-Anholon-Edition is the number of the text's edition\n"};
  const std::size_t of_edition = editions_.seen(request.page, edition);
  const auto give_up = [&] { return stopping_ || editions_.is_old(request.page, edition); };
  Worker& worker = task.brief ? checker_ : movers_[of_edition];
  return reply(task, worker.ask(question, task.seconds, give_up));
}

HttpReply Computing::answer(const Task& task, const Question& question) {
  return reply(task, checker_.ask(question, task.seconds, [this] { return stopping_.load(); }));
}

HttpReply Computing::reply(const Task& task, const Worker::Answer& a) {
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

}  // namespace anholon
