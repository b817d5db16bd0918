#include "anholon/system.h"
#include "api/data.h"
#include "dynamics/rate_formulas_of.h"
#include "setup/program.h"

namespace anholon::v1 {

Result<std::string> program_text(const System& system, Language language) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<std::string> {
    of.model->without_contacts(language == Language::python ? "python_code" : "c_code");
    std::string name = of.model->source.name;
    if (const std::size_t slash = name.rfind('/'); slash != std::string::npos) name.erase(0, slash + 1);
    if (const std::size_t dot = name.rfind('.'); dot != std::string::npos) name.erase(dot);
    const auto rates = language == Language::python ? inner::independent_rates(of.scenario, of.choice) : std::nullopt;
    return inner::program_text(of.scenario, of.choice,
                               language == Language::c ? inner::ProgramLanguage::c : inner::ProgramLanguage::python,
                               name, std::string("anholon ") + ANHOLON_VERSION, rates ? &*rates : nullptr);
  });
}

}  // namespace anholon::v1
