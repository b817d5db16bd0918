#include "studio/gate.h"

#include <array>
#include <stdexcept>

#include <sys/random.h>

namespace anholon {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the system gives no random numbers");
  std::string out;
  for (const unsigned char b : bytes) out += "0123456789abcdef"[b >> 4], out += "0123456789abcdef"[b & 15];
  return out;
}

bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference =
        static_cast<unsigned char>(difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  return difference == 0;
}

// Browsers leave out the port 80 of HTTP.
static std::string named(int port) { return port == 80 ? "" : ":" + std::to_string(port); }

Gate::Gate(std::string token, int port)
    : token_(std::move(token)), numeric_("127.0.0.1" + named(port)), local_("localhost" + named(port)) {}

std::string Gate::address() const { return "http://" + numeric_ + "/" + token_ + "/"; }

std::optional<HttpReply> Gate::refuse(const HttpHead& head) const {
  const auto no = [](int status, const char* why) {
    return HttpReply{status, "text/plain; charset=utf-8", std::string(why) + "\n"};
  };
  if (head.host != numeric_ && head.host != local_) return no(403, "this server is reached by 127.0.0.1 only");
  const std::string_view target = head.target;
  const std::size_t end = target.find('/', 1);
  if (target.empty() || target[0] != '/' || !same_secret(target.substr(1, end == target.npos ? end : end - 1), token_))
    return no(403, "the address needs the token that 'anholon studio' printed");
  // The address without its last slash leads to the one with the slash.
  if (end == target.npos)
    return HttpReply{200, "text/html; charset=utf-8",
                     "<!doctype html><title>Anholon studio</title><meta http-equiv=\"refresh\" content=\"0; url=" +
                         token_ + "/\">\n"};
  if (head.method != "GET" && head.method != "POST") return no(405, "the studio knows GET and POST");
  if (!head.origin.empty() && head.origin != "http://" + head.host)
    return no(403, "the request comes from a foreign page");
  if (head.method == "GET") return std::nullopt;
  if (head.origin.empty()) return no(403, "the request does not say from which page it comes");
  if (!head.site.empty() && head.site != "same-origin") return no(403, "the request comes from a foreign page");
  return std::nullopt;
}

std::string Gate::behind_token(const HttpHead& head) const { return head.target.substr(head.target.find('/', 1) + 1); }

}  // namespace anholon
