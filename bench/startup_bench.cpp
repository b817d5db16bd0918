// The time from process start to written CSV: `anholon simulate` on the models of the papers, 10 s of motion at
// tolerance 1e-12. Goal: under 50 ms of wall time each.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace {

const std::string kProgram = std::string(ANHOLON_SOURCE_DIR) + "/build/anholon";

void run(const std::vector<std::string>& words) {
  std::vector<char*> argv;
  for (const std::string& w : words) argv.push_back(const_cast<char*>(w.c_str()));
  argv.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ) != 0) return;
  int status = 0;
  waitpid(child, &status, 0);
}

void simulate_process(benchmark::State& state, const std::string& model) {
  const std::string csv = (std::filesystem::temp_directory_path() / "anholon-bench.csv").string();
  for (auto _ : state) run({kProgram, "simulate", model, "--to", "10", "--tolerance", "1e-12", "--quiet", "-o", csv});
  std::remove(csv.c_str());
}

const bool registered = [] {
  std::vector<std::string> models;
  for (const auto& e : std::filesystem::directory_iterator(std::string(ANHOLON_SOURCE_DIR) + "/models/papers"))
    if (e.path().extension() == ".toml") models.push_back(e.path().string());
  std::sort(models.begin(), models.end());
  for (const std::string& m : models)
    benchmark::RegisterBenchmark(("process/" + std::filesystem::path(m).stem().string()).c_str(), simulate_process, m)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  return true;
}();

}  // namespace
