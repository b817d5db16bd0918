#include "anholon/system.h"
#include "api/data.h"
#include "emit/emit.h"
#include "setup/inputs.h"

namespace anholon::v1 {

Result<std::string> program_text(const System& system, Language language) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<std::string> {
    inner::Workspace s(of.scenario);
    if (const auto d = inner::not_emitted(*s.model, *s.mechanics)) throw inner::Failure(*d);
    inner::EmitOptions options;
    options.name = of.model->source.name;
    if (const std::size_t slash = options.name.rfind('/'); slash != std::string::npos) options.name.erase(0, slash + 1);
    if (const std::size_t dot = options.name.rfind('.'); dot != std::string::npos) options.name.erase(dot);
    options.made_by = std::string("anholon ") + ANHOLON_VERSION;
    options.start = {s.state.t, s.state.q, s.state.qd, s.state.states};
    inner::OpenSystem open = inner::open_inputs(s);
    options.inputs = std::move(open.inputs);
    return (language == Language::c ? inner::emit_c : inner::emit_python)(open.system, s.structure, options);
  });
}

}  // namespace anholon::v1
