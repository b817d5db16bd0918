#include "studio/answers.h"

#include <algorithm>
#include <optional>

#include "anholon/equations.h"
#include "anholon/proof.h"
#include "anholon/system.h"
#include "api/run_data.h"
#include "base/escape.h"
#include "modelfile/contacts.h"
#include "report/page/sections.h"
#include "studio/answer_json.h"
#include "studio/motion_on_page.h"
#include "studio/opened_file.h"

namespace anholon {

class Answers::Desk {
 public:
  std::string answer(const Question& q) {
    JsonWriter json;
    json.open_object();
    try {
      take_up(q);
      if (q.command == "check")
        check(json);
      else if (q.command == "simulate")
        simulate(json);
      else if (q.command == "derive")
        derive(json);
      else
        prove(json);
      return json.close().text();
    } catch (const Failure& e) {
      return troubled(v1::error_of(e, source_));
    } catch (const std::bad_alloc&) {
      forget();
      return troubled(v1::mistake("the model takes more memory than the studio allows", "make the model smaller"));
    }
  }

 private:
  std::string troubled(const v1::Error& error) const { return error_answer(error, source_.name); }

  void forget() {
    motion_.reset(), model_ = {}, names_ = {}, cases_.clear();
    diagnostics_ = {}, known_ = false;
  }

  // Reads the text unless it was the last one that was read. Only files that the opened model named are read.
  void take_up(const Question& q) {
    const bool same_file = q.text == source_.text && q.name == source_.name && q.readable == readable_;
    if (known_ && same_file && q.case_name == (cases_.empty() ? "" : cases_.front())) return;
    forget();
    source_ = {q.name, q.text, q.path};
    readable_ = q.readable;
    if (!q.case_name.empty()) cases_ = {q.case_name};
    try {
      for (const NamedFile& f : files_named(source_))
        if (std::find(readable_.begin(), readable_.end(), f.name) == readable_.end())
          diagnostics_.error(f.span, "the studio reads only files that the model named when it was opened",
                             "save the model and start the studio again");
    } catch (const Failure&) {
      // open_model reports it.
    }
    if (!diagnostics_.has_errors())
      if (const auto opened = open_model(source_, diagnostics_, {}, cases_))
        model_ = opened->model, names_ = opened->names;
    name_the_choice();
    if (model_) source_ = model_->source_text;
    known_ = true;
  }

  // Rewrites messages about the option --case for the choice of the page.
  void name_the_choice() {
    constexpr std::string_view kOption = "--case: ";
    Diagnostics told;
    for (Diagnostic d : diagnostics_.list()) {
      if (d.message.starts_with(kOption))
        d.message = d.message.substr(kOption.size()),
        d.hint = "choose none or another case beside the name of the file" + (d.hint.empty() ? "" : "; " + d.hint);
      told.add(std::move(d));
    }
    told.others = diagnostics_.others;
    diagnostics_ = std::move(told);
  }

  void check(JsonWriter& json) {
    json.key("diagnostics").open_array();
    for (const Diagnostic& d : diagnostics_.list()) anholon::write(json, d, source_);
    json.close().key("names").open_array();
    if (model_) names(json);
    json.close().key("cases").open_array();
    if (model_)
      for (const std::string& name : model_->cases) json.string(name);
    json.close().key("title").string(model_ ? model_->title : "").key("moves").boolean(static_cast<bool>(model_));
  }

  // Returns false if the text is no model; then the answer contains the error.
  bool has_model(JsonWriter& json) const {
    if (model_) return true;
    v1::Error error = v1::error_of(diagnostics_, source_);
    anholon::write(json, error, source_.name);
    return false;
  }

  void names(JsonWriter& json) const {
    const auto add = [&](const std::string& name, const char* what) {
      json.open_object().key("name").string(name).key("what").string(what).close();
    };
    for (const auto& x : model_->coordinates) add(x.name, "coordinate");
    for (const auto& x : model_->parameters) add(x.name, "parameter");
    for (const auto& x : model_->bodies) add(x.name, "body");
    for (const auto& x : model_->states) add(x.name, "state");
    for (const auto& x : model_->controls) add(x.name, "input");
    for (const auto& x : model_->monitors) add(x.name, "monitor");
    for (const auto& x : model_->constraints) add("lambda." + x.name, "multiplier");
  }

  void simulate(JsonWriter& json) {
    if (!has_model(json)) return;
    if (const auto& list = contacts(*names_); !list.empty())
      return anholon::write(json, v1::mistake("the studio computes no motions with contacts", command("simulate")),
                            source_.name);
    if (!move(json)) return;
    motion_->write(json);
  }

  // Returns the command line that does the same with the saved file.
  std::string command(const char* name) const {
    return std::string("anholon ") + name + " " + source_.name + (cases_.empty() ? "" : " --case " + cases_.front());
  }

  // Computes the motion unless it is known. Returns false if there is none; then the answer contains the reason.
  bool move(JsonWriter& json) {
    if (motion_) return true;
    v1::PrepareOptions prepare;
    prepare.form = model_->simulate.form.value_or("routh");
    const auto system = v1::prepare(v1::Model(data_of_model()), prepare);
    if (!system) return anholon::write(json, system.error(), source_.name), false;
    v1::MotionOptions options;
    options.cancelled = end_of_motion();
    const auto run = v1::simulate(*system, options);
    if (!run) return anholon::write(json, run.error(), source_.name), false;
    if (run->rows() == 0) return anholon::write(json, without_rows(*run), source_.name), false;
    motion_ = std::make_unique<MotionOnPage>(*run, command("report"));
    return true;
  }

  void derive(JsonWriter& json) {
    if (!has_model(json)) return;
    if (!contacts(*names_).empty()) return derive_no_mode(json);
    JsonWriter no_motion;
    no_motion.open_object();
    if (!move(no_motion)) return derive_alone(json);
    add_equations();
    json.key("sections").open_array();
    section(json, "system", "System", system_section(parts().page()));
    section(json, "equations", "Equations of motion", equations_section(parts().page()));
    section(json, "structure", "Structure", structure_section(parts().page()));
    json.close();
  }

  static void derive_no_mode(JsonWriter& json) {
    json.key("sections").open_array();
    section(
        json, "equations", "Equations of motion",
        "<p>Each mode of the contacts has equations of its own. Write what touches as a <code>[[constraint]]</code> "
        "to see those of a mode in which it touches.</p>");
    json.close();
  }

  // Writes the equations of a model that has no motion, because numbers or a start are missing.
  void derive_alone(JsonWriter& json) const {
    v1::DeriveOptions options;
    options.form = model_->simulate.form.value_or("routh");
    if (options.form == "auto") options.form = "routh";
    const auto equations = v1::derive(v1::Model(data_of_model()), options);
    if (!equations) return anholon::write(json, equations.error(), source_.name);
    json.key("sections").open_array();
    section(json, "equations", "Equations of motion", "<div class=\"wide\">" + equations->mathml + "</div>");
    json.close();
  }

  PageInParts& parts() { return motion_->parts(); }

  void add_equations() {
    if (parts().page().equations.empty()) parts().add_equations();
  }

  void prove(JsonWriter& json) {
    if (!has_model(json)) return;
    if (!contacts(*names_).empty()) return;
    JsonWriter no_motion;
    no_motion.open_object();
    if (!move(no_motion)) return prove_alone(json);
    add_equations();
    if (!parts().page().proof && parts().page().no_proof.empty()) parts().add_proof();
    json.key("sections").open_array();
    section(json, "proof", "Proof that the forms agree", proof_section(parts().page()));
    json.close();
  }

  // Writes the proof for a model that has no motion, form by form.
  void prove_alone(JsonWriter& json) const {
    const auto proof = v1::prove(v1::Model(data_of_model()));
    if (!proof) return anholon::write(json, proof.error(), source_.name);
    std::string text = "<p>Each form against Routh's equations, by exact algebra.</p>\n<ul>";
    for (const v1::FormVerdict& f : proof->forms) {
      const bool proved = f.verdict == v1::Verdict::proved, refuted = f.verdict == v1::Verdict::refuted;
      text += "<li>" + markup_escape(f.form) + ": " +
              (proved ? "proved equal" : (refuted ? "differs: " : "not decided: ") + markup_escape(f.detail)) + "</li>";
    }
    json.key("sections").open_array();
    section(json, "proof", "Proof that the forms agree", text + "</ul>\n");
    json.close();
  }

  std::shared_ptr<v1::Model::Data> data_of_model() const {
    auto data = std::make_shared<v1::Model::Data>();
    data->source = source_, data->cases = cases_, data->model = model_;
    return data;
  }

  SourceText source_;
  std::vector<std::string> readable_;
  std::vector<std::string> cases_;  // the chosen case, if any
  bool known_ = false;
  Diagnostics diagnostics_;
  std::shared_ptr<const Model> model_;
  std::shared_ptr<Names> names_;
  std::unique_ptr<MotionOnPage> motion_;
};

Answers::Answers() : desk_(std::make_unique<Desk>()) {}
Answers::~Answers() = default;
std::string Answers::answer(const Question& question) { return desk_->answer(question); }

}  // namespace anholon
