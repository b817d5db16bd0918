// The module behind kernel/code.h: LLVM IR by the Emitter, machine code by ORC, kept on disk between runs.
#include <llvm/ExecutionEngine/Orc/LLJIT.h>
#include <llvm/Support/MemoryBuffer.h>
#include <llvm/Support/TargetSelect.h>
#include <llvm/Support/xxhash.h>
#include <llvm/Target/TargetMachine.h>
#include <llvm/IR/LegacyPassManager.h>
#include <llvm/TargetParser/Host.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <system_error>

#include <unistd.h>

#include "jit/emitter.h"

namespace anholon::jit {

namespace {

// Raise it when the code for one and the same plan changes.
constexpr int kCodeVersion = 1;

extern "C" {
static void anholon_sincos(double x, double* sine, double* cosine) { __builtin_sincos(x, sine, cosine); }
static double anholon_power(double x, double exponent) {
  return exponent == -0.5 ? 1 / std::sqrt(x) : exponent == 1.5 ? x * std::sqrt(x) : exponent == -1.5 ? 1 / (x * std::sqrt(x)) : std::pow(x, exponent);
}
static double anholon_function(int function, double u) {
  using std::abs, std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::sinh, std::cosh, std::tanh, std::asinh, std::acosh, std::atanh, std::exp, std::log;
  const auto sign = [](double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; };
  switch (static_cast<Function>(function)) {
#define ROW(name, derivative, parity, latex, domain) \
  case Function::name: return name(u);
#include "expr/elementary.def"
#undef ROW
  }
  return u;
}
}

std::string text_of(llvm::Error error) { return llvm::toString(std::move(error)); }

std::unique_ptr<llvm::TargetMachine> machine(llvm::orc::JITTargetMachineBuilder& builder) {
  builder.setCodeGenOptLevel(llvm::CodeGenOptLevel::Default);
  builder.setRelocationModel(llvm::Reloc::PIC_);
  auto made = builder.createTargetMachine();
  if (!made) return nullptr;
  return std::move(*made);
}

std::unique_ptr<llvm::MemoryBuffer> object_of(llvm::Module& module, llvm::TargetMachine& target) {
  llvm::SmallVector<char, 0> bytes;
  llvm::raw_svector_ostream out(bytes);
  llvm::legacy::PassManager passes;
  if (target.addPassesToEmitFile(passes, out, nullptr, llvm::CodeGenFileType::ObjectFile)) return nullptr;
  passes.run(module);
  return llvm::MemoryBuffer::getMemBufferCopy(llvm::StringRef(bytes.data(), bytes.size()), "kernel");
}

// An object file is followed by its own hash: a file cut short, or written by somebody else, is not taken.
std::unique_ptr<llvm::MemoryBuffer> read(const std::filesystem::path& file) {
  auto buffer = llvm::MemoryBuffer::getFile(file.string(), false, false);
  if (!buffer || (*buffer)->getBufferSize() < sizeof(std::uint64_t)) return nullptr;
  const llvm::StringRef all = (*buffer)->getBuffer(), body = all.drop_back(sizeof(std::uint64_t));
  std::uint64_t hash = 0;
  std::memcpy(&hash, all.end() - sizeof hash, sizeof hash);
  if (hash != llvm::xxh3_64bits(body)) return nullptr;
  return llvm::MemoryBuffer::getMemBufferCopy(body, "kernel");
}

// Under a name of its own first, then renamed: whoever looks finds all of it or nothing, however many write at once.
void write(const std::filesystem::path& file, const llvm::MemoryBuffer& object) {
  std::error_code none;
  std::filesystem::create_directories(file.parent_path(), none);
  const std::filesystem::path part = file.string() + "." + std::to_string(getpid()) + "." + std::to_string(reinterpret_cast<std::uintptr_t>(&object));
  std::FILE* out = std::fopen(part.c_str(), "wb");
  if (!out) return;
  const std::uint64_t hash = llvm::xxh3_64bits(object.getBuffer());
  const bool good = std::fwrite(object.getBufferStart(), 1, object.getBufferSize(), out) == object.getBufferSize() && std::fwrite(&hash, sizeof hash, 1, out) == 1;
  if (std::fclose(out) == 0 && good) std::filesystem::rename(part, file, none);
  else std::filesystem::remove(part, none);
}

void compile(const KernelTables& tables, const std::string& cache, Code& code, std::string& message) {
  static std::once_flag once;
  std::call_once(once, [] {
    llvm::InitializeNativeTarget();
    llvm::InitializeNativeTargetAsmPrinter();
  });
  auto builder = llvm::orc::JITTargetMachineBuilder::detectHost();
  if (!builder) return void(message = text_of(builder.takeError()));
  const std::unique_ptr<llvm::TargetMachine> target = machine(*builder);
  if (!target) return void(message = "no compiler for this machine");

  auto context = std::make_unique<llvm::LLVMContext>();
  llvm::Module module("kernel", *context);
  module.setDataLayout(target->createDataLayout());
  module.setTargetTriple(target->getTargetTriple().str());
  Emitter(tables, module).run();

  // The key is all that decides the code: the IR itself, the machine, the version.
  std::string text;
  llvm::raw_string_ostream(text) << module << target->getTargetCPU() << target->getTargetFeatureString() << LLVM_VERSION_STRING << kCodeVersion;
  char name[32];
  std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(llvm::xxh3_64bits(text)));
  const std::filesystem::path file = cache.empty() ? std::filesystem::path() : std::filesystem::path(cache) / (std::string("kernel-") + name + ".o");
  std::unique_ptr<llvm::MemoryBuffer> object = cache.empty() ? nullptr : read(file);
  if (!object) {
    object = object_of(module, *target);
    if (!object) return void(message = "the compiler made nothing");
    if (!cache.empty()) write(file, *object);
  }

  auto jit = llvm::orc::LLJITBuilder().setJITTargetMachineBuilder(*builder).create();
  if (!jit) return void(message = text_of(jit.takeError()));
  llvm::orc::SymbolMap symbols;
  const auto add = [&](const char* symbol, auto* function) {
    symbols[(*jit)->mangleAndIntern(symbol)] = {llvm::orc::ExecutorAddr::fromPtr(function), llvm::JITSymbolFlags::Exported | llvm::JITSymbolFlags::Callable};
  };
  add("anholon_sincos", &anholon_sincos);
  add("anholon_power", &anholon_power);
  add("anholon_function", &anholon_function);
  add("atan2", static_cast<double (*)(double, double)>(&std::atan2));
  if (auto error = (*jit)->getMainJITDylib().define(llvm::orc::absoluteSymbols(std::move(symbols)))) return void(message = text_of(std::move(error)));
  if (auto error = (*jit)->addObjectFile(std::move(object))) return void(message = text_of(std::move(error)));
  const auto find = [&](const char* part) -> Code::Part {
    auto symbol = (*jit)->lookup(part);
    if (!symbol) {
      message = text_of(symbol.takeError());
      return nullptr;
    }
    return symbol->toPtr<Code::Part>();
  };
  Code made;
  made.values = find("values");
  made.factor = find("factor");
  made.lead = find("lead");
  made.extend = find("extend");
  made.advance = find("advance");
  for (int level = 1; level <= Emitter::levels(tables); ++level) made.level.push_back(find(Emitter::level_name(level).c_str()));
  if (!message.empty()) return;
  made.keeper = std::shared_ptr<void>(jit->release(), [](void* p) { delete static_cast<llvm::orc::LLJIT*>(p); });
  code = std::move(made);
}

}  // namespace

}  // namespace anholon::jit

extern "C" __attribute__((visibility("default"))) const anholon::CompilerModule anholon_compiler;
const anholon::CompilerModule anholon_compiler{anholon::kCompilerVersion, anholon::jit::compile};
