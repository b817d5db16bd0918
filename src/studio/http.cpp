#include "studio/http.h"

#include <array>
#include <charconv>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

namespace anholon {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

using Refuse = std::function<std::optional<HttpReply>(const HttpHead&)>;
using Handle = std::function<HttpReply(const HttpRequest&)>;

// The data that all connections share.
struct Service {
  HttpLimits limits;
  Refuse refuse;
  Handle handle;
  asio::thread_pool* pool = nullptr;
  std::size_t connections = 0;  // used by the one thread that moves bytes
};

std::string text(boost::string_view view) { return {view.data(), view.size()}; }

// Returns the value of a field that occurs once; otherwise an empty text.
template <class Fields, class Name>
std::string only(const Fields& fields, Name name) {
  return fields.count(name) == 1 ? text(fields[name]) : std::string();
}

// Returns the text of a percent-encoded field; a % without two digits is kept.
std::string decoded(const std::string& field) {
  std::string out;
  for (std::size_t i = 0; i < field.size(); ++i) {
    unsigned char byte = 0;
    const char* from = field.data() + i + 1;
    if (field[i] == '%' && i + 2 < field.size() && std::from_chars(from, from + 2, byte, 16).ptr == from + 2)
      out += static_cast<char>(byte), i += 2;
    else
      out += field[i];
  }
  return out;
}

class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket&& socket, Service& service) : stream_(std::move(socket)), service_(service) {
    ++service_.connections;
    parser_.header_limit(static_cast<std::uint32_t>(service_.limits.head));
    parser_.body_limit(service_.limits.body);
  }
  ~Session() { --service_.connections; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start() {
    if (service_.connections > service_.limits.connections) return;  // the connection closes
    stream_.expires_after(std::chrono::seconds(service_.limits.seconds));
    http::async_read_header(stream_, buffer_, parser_,
                            [self = shared_from_this()](error_code error, std::size_t) { self->read_head(error); });
  }

 private:
  void read_head(error_code error) {
    if (error) return refused(error);
    const auto& fields = parser_.get();
    HttpHead& head = request_.head;
    head = {text(fields.method_string()), text(fields.target()), only(fields, http::field::host),
            only(fields, http::field::origin), only(fields, "Sec-Fetch-Site")};
    request_.page = only(fields, "X-Anholon-Page"), request_.edition = only(fields, "X-Anholon-Edition");
    request_.known = only(fields, "X-Anholon-Known");
    request_.case_name = decoded(only(fields, "X-Anholon-Case"));
    if (std::optional<HttpReply> no = service_.refuse(head)) return send(std::move(*no));
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](error_code e, std::size_t) { self->read_body(e); });
  }

  void read_body(error_code error) {
    if (error) return refused(error);
    request_.body = std::move(parser_.get().body());
    stream_.expires_never();  // the handler has its own limits
    asio::post(*service_.pool, [self = shared_from_this()]() mutable {
      HttpReply reply = self->service_.handle(self->request_);
      // The session ends in the thread that moves bytes.
      const auto executor = self->stream_.get_executor();
      asio::post(executor, [moved = std::move(self), r = std::move(reply)]() mutable { moved->send(std::move(r)); });
    });
  }

  void refused(error_code error) {
    if (error == http::error::body_limit)
      return send({413, "text/plain; charset=utf-8",
                   "the text is longer than " + std::to_string(service_.limits.body >> 10) + " KiB\n"});
    if (error == http::error::header_limit)
      return send({431, "text/plain; charset=utf-8", "the head of the request is too long\n"});
    if (error.category() == http::make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message)
      send({400, "text/plain; charset=utf-8", "this is not a request of HTTP\n"});
  }

  void send(HttpReply reply) {
    response_.result(static_cast<unsigned>(reply.status));
    response_.version(11);
    response_.keep_alive(false);
    response_.set(http::field::content_type, reply.type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    // Styles are inline because the editor and the sections of a report contain them; scripts are files of the studio.
    response_.set(
        "Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; font-src data:; img-src "
        "'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    response_.body() = std::move(reply.body);
    response_.prepare_payload();
    stream_.expires_after(std::chrono::seconds(service_.limits.seconds));
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) { self->close(); });
  }

  // Reads the remaining bytes: otherwise the system would reset the connection before the reply arrives.
  void close() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    drain();
  }
  void drain() {
    if (drained_ > 4 * service_.limits.body) return;
    stream_.expires_after(std::chrono::seconds(1));
    stream_.async_read_some(asio::buffer(rest_), [self = shared_from_this()](error_code error, std::size_t n) {
      self->drained_ += n;
      if (!error) self->drain();
    });
  }

  beast::tcp_stream stream_;
  Service& service_;
  beast::flat_buffer buffer_{64 << 10};
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  HttpRequest request_;
  std::array<char, 4096> rest_{};
  std::size_t drained_ = 0;
};

}  // namespace

class HttpServer::Inner {
 public:
  Inner(int port, const HttpLimits& limits) : limits_(limits) {
    service_.limits = limits;
    const tcp::endpoint place(asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port));
    error_code error;
    acceptor_.open(place.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(place, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error == asio::error::address_in_use)
      throw std::runtime_error("port " + std::to_string(port) + " is taken by another program");
    if (error) throw std::runtime_error("port " + std::to_string(port) + " cannot be opened: " + error.message());
  }
  int port() const { return acceptor_.local_endpoint().port(); }

  void run(Refuse refuse, Handle handle, std::function<void()> stopping) {
    asio::thread_pool pool(static_cast<std::size_t>(limits_.threads));
    service_.refuse = std::move(refuse), service_.handle = std::move(handle), service_.pool = &pool;
    stopping_ = std::move(stopping);
    signals_.async_wait([this](error_code error, int) {
      if (!error) end();
    });
    accept();
    io_.run();
    pool.join();
    io_.restart();
    io_.poll();
  }

 private:
  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (!error) std::make_shared<Session>(std::move(socket), service_)->start();
      accept();
    });
  }
  void end() {
    if (ended_) return;
    ended_ = true;
    error_code ignored;
    acceptor_.close(ignored);
    stopping_();
    io_.stop();
  }

  HttpLimits limits_;
  Service service_;  // outlives the sessions, which belong to the context
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  asio::signal_set signals_{io_, SIGINT, SIGTERM};
  std::function<void()> stopping_;
  bool ended_ = false;
};

HttpServer::HttpServer(int port, const HttpLimits& limits) : inner_(std::make_unique<Inner>(port, limits)) {}
HttpServer::~HttpServer() = default;
int HttpServer::port() const { return inner_->port(); }
void HttpServer::run(std::function<std::optional<HttpReply>(const HttpHead&)> refuse,
                     std::function<HttpReply(const HttpRequest&)> handle, std::function<void()> stopping) {
  inner_->run(std::move(refuse), std::move(handle), std::move(stopping));
}

}  // namespace anholon
