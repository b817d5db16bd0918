// A small HTTP server on the loopback address: one request per connection, with limits of size, time and number.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace anholon {

// The head of a request, before its body is read. A field is empty if it is missing or occurs twice.
struct HttpHead {
  std::string method, target, host, origin, site;  // site: Sec-Fetch-Site
};

struct HttpRequest {
  HttpHead head;
  std::string page, edition;  // X-Anholon-Page, X-Anholon-Edition
  std::string case_name;      // X-Anholon-Case, which is percent-encoded
  std::string known;          // X-Anholon-Known, the hash of the file as the page knows it
  std::string body;
};

struct HttpReply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8", body;
};

struct HttpLimits {
  std::size_t head = 16 << 10, body = 1 << 20;  // bytes
  int seconds = 10;                             // to send a request, and to receive a reply
  std::size_t connections = 32;
  int threads = 4;  // the threads that handle requests
};

class HttpServer {
 public:
  // Binds 127.0.0.1; port 0 takes a free one. Throws std::runtime_error with the reason if it cannot.
  HttpServer(int port, const HttpLimits& limits);
  ~HttpServer();
  int port() const;
  // Serves until SIGINT or SIGTERM; then `stopping` is called, before the threads are awaited. `refuse` gets the head
  // alone and may reply in place of `handle`, which many threads call.
  void run(std::function<std::optional<HttpReply>(const HttpHead&)> refuse,
           std::function<HttpReply(const HttpRequest&)> handle, std::function<void()> stopping);

 private:
  class Inner;
  std::unique_ptr<Inner> inner_;
};

}  // namespace anholon
