#include "interruptible.h"

NB_MODULE(_core, m) {
  using namespace nanobind::literals;
  // Objects that a script holds at its end, such as an array that reads the numbers of a run, are no leak.
  nanobind::set_leak_warnings(false);
  m.doc() = "The C++ library of Anholon, as its public headers have it.";
  anholon::python::bind_results(m);
  anholon::python::bind_arrow(m);
  anholon::python::bind_models(m);
  anholon::python::bind_motions(m);
  anholon::python::bind_sweeps(m);
  anholon::python::bind_sweep_folders(m);
  anholon::python::bind_dynamics(m);
  anholon::python::bind_analysis(m);
  m.def("running", anholon::python::Running::count,
        "How many threads of the library compute for a call; 0 once all calls have ended, by Ctrl-C or by themselves.");
  nanobind::module_::import_("atexit").attr("register")(nanobind::cpp_function(anholon::python::Ending::wait));
  nanobind::module_::import_("os").attr("register_at_fork")(
      "after_in_child"_a = nanobind::cpp_function(anholon::python::Ending::forget_other_threads));
}
