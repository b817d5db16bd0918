#include "anholon/system.h"
#include "api/data.h"
#include "contact/mode/switched_model.h"
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
    const std::vector<std::size_t> switching =
        inner::switching_parameters(*of.model->model, of.model->contacts_of_file);
    const auto rates =
        language == Language::python ? inner::independent_rates(of.scenario, of.choice, switching) : std::nullopt;
    return inner::program_text(of.scenario, of.choice,
                               language == Language::c ? inner::ProgramLanguage::c : inner::ProgramLanguage::python,
                               name, std::string("anholon ") + ANHOLON_VERSION, {rates ? &*rates : nullptr, switching});
  });
}

}  // namespace anholon::v1
