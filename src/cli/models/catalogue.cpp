#include <cstdio>

#include "base/json.h"
#include "cli/input.h"
#include "cli/say.h"

namespace anholon::cli {

int forms(const SystemCommand& o) {
  std::optional<Reader> in;
  std::optional<Mechanics> m;
  if (!o.model.empty()) {
    in = read(o);
    m = mechanics(*in->model);
  }
  if (o.json) {
    JsonWriter j;
    j.open_array();
    for (const Formulation* f : formulations()) {
      const std::string why = m ? obstacle(*f, *m) : std::string();
      j.open_object().key("name").string(f->name).key("title").string(f->title).key("equation").string(f->equation);
      j.key("source").string(f->source).key("applies").boolean(why.empty()).key("reason").string(why).close();
    }
    hand_out(j.close().text() + "\n");
    return kOk;
  }
  for (const Formulation* f : formulations()) {
    say(stdout, "%-28s %s\n%-28s %s\n", f->name, f->title, "", citation(*f).c_str());
    if (m) {
      const std::string why = obstacle(*f, *m);
      say(stdout, "%-28s %s\n", "", why.empty() ? "applies" : ("does not apply: " + why).c_str());
    }
  }
  return kOk;
}

int models(const ModelCommand& o) {
  const std::vector<ShippedFile> list = shipped(Shipped::models);
  if (!o.model.empty()) {
    const Reader r = read(o);
    hand_out(r.source.text);
    return kOk;
  }
  if (o.json) {
    JsonWriter j;
    j.open_array();
    for (const ShippedFile& m : list) j.open_object().key("name").string(m.name).key("title").string(m.title).close();
    hand_out(j.close().text() + "\n");
    return kOk;
  }
  for (const ShippedFile& m : list) say(stdout, "%-34s %s\n", m.name.c_str(), m.title.c_str());
  return kOk;
}

}  // namespace anholon::cli
