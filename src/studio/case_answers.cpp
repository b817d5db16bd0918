#include "studio/case_answers.h"

#include <charconv>

#include "api/data.h"
#include "api/sweep_case.h"
#include "studio/answer_json.h"
#include "studio/motion_on_page.h"

namespace anholon {

namespace {

// Returns the number of a case. Throws Failure without a place.
std::size_t number_of_case(const std::string& text) {
  std::size_t number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, why] = std::from_chars(text.data(), end, number);
  if (text.empty() || rest != end || why != std::errc())
    throw Failure({}, "'" + text + "' is no number of a case", "a whole number: 0, 1, 2, …");
  return number;
}

std::string motion_of_case(const std::string& folder, std::size_t number) {
  const SweepStore store = v1::opened_to_read(folder);
  const v1::Result<v1::System> system = v1::system_of_case(store, number);
  if (!system) return error_answer(system.error(), "");
  v1::MotionOptions options = v1::drawn_case(store, *system);
  options.cancelled = end_of_motion();
  const v1::Result<v1::Run> run = v1::simulate(*system, options);
  if (!run) return error_answer(run.error(), "");
  if (run->rows() == 0) return error_answer(without_rows(*run), "");
  const std::string command = v1::command_of_case(store, number);
  JsonWriter json;
  json.open_object().key("number").integer(static_cast<long long>(number)).key("command").string(command);
  MotionOnPage(*run, command).write(json);
  return json.close().text();
}

}  // namespace

std::string CaseAnswers::answer(const Question& q) const {
  try {
    return q.command == "sweep" ? map_(q.path) : motion_of_case(q.path, number_of_case(q.text));
  } catch (const Failure& e) {
    return error_answer(v1::error_of(e, {}), "");
  } catch (const std::bad_alloc&) {
    return error_answer(v1::mistake("the sweep takes more memory than the studio allows", "anholon plot has no limit"),
                        "");
  }
}

}  // namespace anholon
