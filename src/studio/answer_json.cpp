#include "studio/answer_json.h"

namespace anholon {

namespace {

const char* word(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

}  // namespace

void write(JsonWriter& json, const Diagnostic& d, const SourceText& source) {
  const SourceText& file = source.of(d.span);
  json.open_object().key("severity").string(word(d.severity)).key("message").string(d.message);
  json.key("hint").string(d.hint).key("file").string(&file == &source ? "" : file.name);
  json.key("line")
      .integer(d.span.line)
      .key("column")
      .integer(d.span.column)
      .key("length")
      .integer(d.span.length)
      .close();
}

void write(JsonWriter& json, const v1::Error& error, const std::string& name) {
  json.key("error").open_object();
  json.key("text").string(!error.diagnostics.empty() ? error.diagnostics.front().message
                          : error.outcome            ? error.outcome->message
                                                     : error.text);
  json.key("hint").string(!error.diagnostics.empty() ? error.diagnostics.front().hint
                          : error.outcome            ? error.outcome->hint
                                                     : "");
  json.key("outcome").string(error.outcome ? v1::name(error.outcome->kind) : "");
  json.key("diagnostics").open_array();
  for (const v1::Diagnostic& d : error.diagnostics) {
    json.open_object().key("severity").string(word(static_cast<Severity>(d.severity)));
    json.key("message").string(d.message).key("hint").string(d.hint);
    json.key("file").string(d.file == name ? "" : d.file);
    json.key("line").integer(d.line).key("column").integer(d.column).key("length").integer(d.length).close();
  }
  json.close().close();
}

void section(JsonWriter& json, const char* id, const char* title, const std::string& body) {
  if (body.empty()) return;
  json.open_object().key("id").string(id).key("title").string(title).key("html").string(body).close();
}

std::string error_answer(const v1::Error& error, const std::string& name) {
  JsonWriter json;
  json.open_object();
  write(json, error, name);
  return json.close().text();
}

}  // namespace anholon
