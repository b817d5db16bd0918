// Decides who may talk to the studio: the page that has the token of its address, in a browser of this machine.
//
// Another page that the browser shows can send requests to the loopback address, and a name server can make a foreign
// name point to it. So each request must name this host (Host), carry the token in its path, and, if it changes or
// computes something, come from a page of this address (Origin).
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "studio/http.h"

namespace anholon {

// Returns 128 random bits of the system, in hexadecimal digits. Throws std::runtime_error if the system gives none.
std::string random_token();

// True if the texts are equal. It takes the same time for all texts of one length.
bool same_secret(std::string_view a, std::string_view b);

class Gate {
 public:
  Gate(std::string token, int port);
  // The address of the page.
  std::string address() const;
  // Returns the reply to a refused request; nullopt if the request may pass.
  std::optional<HttpReply> refuse(const HttpHead& head) const;
  // Returns the part of the path behind the token, such as "check". REQUIRES: the request was not refused.
  std::string behind_token(const HttpHead& head) const;

 private:
  std::string token_, numeric_, local_;  // the two names of the host, with the port
};

}  // namespace anholon
