// The command line words of the commands that derive, prove and compare.
#include "cli/command_words.h"
#include "result/format.h"

namespace anholon::cli {

void add_derive(CommandLine& line) {
  const auto [c, o] =
      line.model_command("derive", "print the equations of motion", cli::derive,
                         "The initial state is the start of programs; at it the coordinates are chosen that forms "
                         "without multipliers eliminate.\n"
                         "Examples: anholon derive disc --format latex\n"
                         "          anholon derive luo-zhao-example-2 --reactions\n"
                         "          anholon derive chaplygin-sleigh --form nielsen-reduced --m 3 --steps");
  parameters(c, o), state(c, o), form_option(c, o), mode_of_contacts(c, o);
  c->add_option("--format", o.format,
                "text, latex, mathml or json; c (C99) or python (NumPy): a program that computes the motion's right "
                "side\n(default: by the end of FILE, else text)")
      ->type_name("FORMAT")
      ->each([&given = o.format_given](const std::string&) { given = true; });
  c->add_option("-o,--output", o.output,
                "FILE.txt, FILE.tex, FILE.html, FILE.json, FILE.c or FILE.py (default: the standard output)")
      ->type_name("FILE");
  c->add_option("--expand", o.expand,
                "auto or paper (grouped), none, full (written out), parts (named, for many coordinates)")
      ->type_name("HOW");

  c->add_flag("--steps", o.steps,
              "show the forces, constraints, the elimination and the quantities of the form on the way");
  c->add_flag("--reactions", o.reactions,
              "show multipliers, generalized reactions and the reactions on each body as formulas, too");
  order_m(c, o.m);
}

void add_prove(CommandLine& line) {
  const auto [c, o] =
      line.model_command("prove", "prove that the forms of the equations agree, and show which do not", cli::prove,
                         "Ctrl-C ends the proof and says which forms were compared until then.\n"
                         "Exit status: 0 every pair is decided, 1 one stays unknown or Ctrl-C, 2 bad input.\n"
                         "Example: anholon prove luo-zhao-example-2 -o proof.json && anholon verify proof.json");
  mode_of_contacts(c, o);
  c->add_option("--forms", o.forms, "only these forms: routh,chaplygin (default: all that apply)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  parameters(c, o);
  c->add_option("--eliminate", o.eliminate, "dependent coordinates of the forms without multipliers (default: chosen)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  order_m(c, o.m);
  c->add_option("--digits", o.digits_of_enclosures,
                "of the enclosures that tell a difference from zero, at most (default 308)")
      ->type_name("N")
      ->check(CLI::Range(20, 20000));
  c->add_option("-o,--output", o.output, "write a certificate")->type_name("FILE");
}

void add_compare(CommandLine& line) {
  const auto [c, o] = line.model_command(
      "compare", "published equations against the derived ones: proved, refuted, or unknown", cli::compare,
      "EQUATIONS holds one equation per line, LABEL: left = right, in the names of the model, multipliers "
      "(lambda.NAME), energies and forces\n"
      "(T_r, Q.x, Gamma.x, N.x), partial and frozen derivatives, equations of forms (maggi.x): doc/equations.md.\n"
      "Where changes of up to four places make a false equation true, they are named.\n"
      "Exit status: 0 all are true, 1 one is false or stays unknown, 2 bad input.\n"
      "Example: anholon compare luo-zhao-example-1-symbolic luo-zhao-example-1.as-read");
  c->add_option("EQUATIONS", o.equations,
                "a file of equations, the name of a shipped one, or - for what comes through a pipe");
  parameters(c, o), mode_of_contacts(c, o);
  c->add_option("--eliminate", o.eliminate, "coordinates for which the constraints are solved (default: chosen)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
}

void add_papers(CommandLine& line) {
  const auto [c, o] =
      line.command("papers", "the papers behind the program: every numbered equation, decided", cli::papers,
                   "Without a tag: all papers with their equations and verdicts. A tag in any spelling: L3.13, "
                   "\"[L 3.13]\", 3.18', "
                   "Q13, N3.16.\n"
                   "What is true is proved and a mutant of it refuted; what is false is refuted, and its "
                   "corrected version proved.\n"
                   "Exit status: 0 all is as the tables say, 1 something is not, 2 bad input.\n"
                   "Examples: anholon papers L3.13\n"
                   "          anholon papers --check");
  c->add_option("TAG", o.tag, "one equation");
  c->add_flag("--check", o.check, "decide all, and count");
  c->add_flag("--json", o.json, "JSON on the standard output");
  c->add_flag("--markdown", o.markdown, "the tables in Markdown");
  c->add_flag("--quiet", o.quiet, "no progress");
}

void add_verify(CommandLine& line) {
  const auto [c, o] = line.command(
      "verify", "check a certificate, independently of what wrote it", cli::verify,
      "Exit status: 0 all claims confirmed, 1 one is contradicted or could not be checked, 2 not a certificate.\n"
      "Example: anholon verify disc.json");
  c->add_option("CERTIFICATE", o.certificate, "a certificate file")->required();
  c->add_flag("--json", o.json, "JSON on the standard output");
  c->add_flag("--quiet", o.quiet, "the exit status only");
  c->add_option("--points", o.points, "random points modulo each of two primes (default 6)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  c->add_option("--digits", o.digits, "of the enclosures at witnesses, at most (default 308)")
      ->type_name("N")
      ->check(CLI::Range(20, 20000));
  seed_option(c, o.seed, "another choice of points (default 0)");
}

}  // namespace anholon::cli
