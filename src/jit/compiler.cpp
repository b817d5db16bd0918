// The module behind kernel/code.h: LLVM IR from the Emitter, machine code from ORC, stored on disk between runs.
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include <elf.h>
#include <link.h>
#include <llvm/ExecutionEngine/Orc/LLJIT.h>
#include <llvm/IR/LegacyPassManager.h>
#include <llvm/Support/CommandLine.h>
#include <llvm/Support/TargetSelect.h>
#include <llvm/Target/TargetMachine.h>

#include "jit/emitter.h"
#include "jit/store.h"
#include "jit/x86/translated_module.h"

extern "C" __attribute__((visibility("default"))) const anholon::CompilerModule anholon_compiler;
extern "C" __attribute__((visibility("default"))) const char anholon_compiler_layout[];

namespace anholon::jit {

namespace {

using Builder = llvm::orc::JITTargetMachineBuilder;

std::string text_of(llvm::Error error) { return llvm::toString(std::move(error)); }

// Returns the build ID of the library that contains an address: a hash of its contents, made by the linker. Empty if
// there is none.
std::string build_of(const void* address) {
  struct Question {
    std::uintptr_t address;
    std::string answer;
  } question{reinterpret_cast<std::uintptr_t>(address), {}};
  dl_iterate_phdr(
      [](dl_phdr_info* library, std::size_t, void* data) -> int {
        auto& q = *static_cast<Question*>(data);
        bool here = false;
        for (int i = 0; i < library->dlpi_phnum; ++i) {
          const ElfW(Phdr)& part = library->dlpi_phdr[i];
          here = here || (part.p_type == PT_LOAD && q.address - (library->dlpi_addr + part.p_vaddr) < part.p_memsz);
        }
        if (!here) return 0;
        for (int i = 0; i < library->dlpi_phnum; ++i) {
          const ElfW(Phdr)& part = library->dlpi_phdr[i];
          if (part.p_type != PT_NOTE) continue;
          const auto padded = [](std::size_t n) { return (n + 3) / 4 * 4; };
          const char* at = reinterpret_cast<const char*>(library->dlpi_addr + part.p_vaddr);
          for (const char* end = at + part.p_memsz; at + sizeof(ElfW(Nhdr)) <= end;) {
            const auto* note = reinterpret_cast<const ElfW(Nhdr)*>(at);
            const char *name = at + sizeof *note, *text = name + padded(note->n_namesz);
            if (note->n_type == NT_GNU_BUILD_ID && std::string(name, note->n_namesz) == std::string("GNU", 4))
              q.answer.assign(text, note->n_descsz);
            at = text + padded(note->n_descsz);
          }
        }
        return 1;
      },
      &question);
  return question.answer;
}

// Names all inputs of the code: this module, of which LLVM is a part, the machine, the plan. Returns false if the build
// has no ID; stored code is then not used.
bool name(const KernelTables& tables, int lanes, CodeEffort effort, int several_sines, std::size_t part,
          const Builder& builder, Key& key) {
  static const std::string ours = build_of(&anholon_compiler);
  if (ours.empty()) return false;
  Writer w;
  w.add(ours);
  w.add(builder.getTargetTriple().str()), w.add(builder.getCPU()), w.add(builder.getFeatures().getString());
  w.add(std::to_string(lanes)), w.add(std::to_string(several_sines)), w.add(std::to_string(part));
  w.add(std::string(effort == CodeEffort::quick ? "quick" : "full"));
  w.add(tables);
  key = w.key();
  return true;
}

// Returns nullopt if the plan has to be compiled.
std::optional<Code> translated(const KernelTables& tables, int lanes, const CalledFunctions& called) try {
  if (!translated_at_first(lanes) || Emitter::parts(tables) > 1) return std::nullopt;
  llvm::LLVMContext context;
  llvm::Module module("kernel", context);
  Emitter(tables, module, lanes, called.several).run();
  return x86::translated_module(module, Emitter::levels(tables), called);
} catch (const std::exception&) {
  return std::nullopt;
}

// The selection of instructions takes more than half of the time, most of it for patterns that the emitter's code does
// not contain, so the search for them is switched off.
void select_quickly(llvm::Module& module) {
  for (llvm::Function& f : module) {
    if (f.isDeclaration()) continue;
    f.addFnAttr(llvm::Attribute::OptimizeNone);
    f.addFnAttr(llvm::Attribute::NoInline);
  }
}

std::unique_ptr<llvm::MemoryBuffer> compiled(const KernelTables& tables, int lanes, CodeEffort effort,
                                             int several_sines, std::size_t part, Builder builder,
                                             std::string& message) {
  auto target = builder.createTargetMachine();
  if (!target) return message = text_of(target.takeError()), nullptr;
  llvm::LLVMContext context;
  llvm::Module module("kernel", context);
  module.setDataLayout((*target)->createDataLayout());
  module.setTargetTriple((*target)->getTargetTriple().str());
  Emitter(tables, module, lanes, several_sines, part).run();
  if (effort == CodeEffort::quick) select_quickly(module);
  llvm::SmallVector<char, 0> bytes;
  llvm::raw_svector_ostream out(bytes);
  llvm::legacy::PassManager passes;
  if ((*target)->addPassesToEmitFile(passes, out, nullptr, llvm::CodeGenFileType::ObjectFile))
    return message = "the compiler makes no object files", nullptr;
  passes.run(module);
  return llvm::MemoryBuffer::getMemBufferCopy(llvm::StringRef(bytes.data(), bytes.size()), "kernel");
}

using Objects = std::vector<std::unique_ptr<llvm::MemoryBuffer>>;

// Compiles the modules of a long plan in as many threads as the machine has. Returns an empty list on failure.
Objects compiled_all(const KernelTables& tables, int lanes, CodeEffort effort, int several_sines,
                     const Builder& builder, std::string& message) {
  const std::size_t count = Emitter::parts(tables);
  Objects objects(count);
  std::vector<std::string> messages(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t part = next++; part < count; part = next++) try {
        objects[part] = compiled(tables, lanes, effort, several_sines, part, builder, messages[part]);
      } catch (const std::exception& error) {
        messages[part] = error.what();  // the tables are used instead
      }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < std::min<std::size_t>(count, std::thread::hardware_concurrency()); ++i)
    others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
  for (std::size_t part = 0; part < count; ++part)
    if (!objects[part]) return message = messages[part], Objects{};
  return objects;
}

Code linked(Objects objects, const Builder& builder, int levels, const CalledFunctions& called, std::string& message) {
  // No platform is set: there are no initializers to run, and the general platform compiles a module of its own.
  auto jit = llvm::orc::LLJITBuilder()
                 .setJITTargetMachineBuilder(builder)
                 .setPlatformSetUp(llvm::orc::setUpInactivePlatform)
                 .create();
  if (!jit) return message = text_of(jit.takeError()), Code{};
  (*jit)->getExecutionSession().setErrorReporter(
      [](llvm::Error error) { llvm::consumeError(std::move(error)); });  // a failure shows at lookup
  llvm::orc::SymbolMap symbols;
  const auto add = [&](const char* symbol, auto* function) {
    symbols[(*jit)->mangleAndIntern(symbol)] = {llvm::orc::ExecutorAddr::fromPtr(function),
                                                llvm::JITSymbolFlags::Exported | llvm::JITSymbolFlags::Callable};
  };
  called.for_each(add);
  if (auto error = (*jit)->getMainJITDylib().define(llvm::orc::absoluteSymbols(std::move(symbols))))
    return message = text_of(std::move(error)), Code{};
  for (auto& object : objects)
    if (auto error = (*jit)->addObjectFile(std::move(object))) return message = text_of(std::move(error)), Code{};
  const auto find = [&](const std::string& part, auto& function) {
    auto symbol = (*jit)->lookup(part);
    if (symbol)
      function = symbol->toPtr<std::remove_reference_t<decltype(function)>>();
    else
      message = text_of(symbol.takeError());
  };
  Code made;
  if (objects.size() == 1)
    made.for_each_part(levels, find);
  else
    find("extend", made.extend);
  if (!message.empty()) return {};
  made.keeper = std::shared_ptr<void>(jit->release(), [](void* p) { delete static_cast<llvm::orc::LLJIT*>(p); });
  return made;
}

void set_option(const char* name, const char* value) {
  const auto& options = llvm::cl::getRegisteredOptions();
  if (const auto o = options.find(name); o != options.end()) o->second->addOccurrence(1, o->first(), value);
}

void compile(const KernelTables& tables, int lanes, CodeEffort effort, const CalledFunctions& called,
             const std::string& cache, Code& code, std::string& message) {
  if (effort == CodeEffort::quick)
    if (auto made = translated(tables, lanes, called)) return void(code = std::move(*made));
  static std::once_flag once;
  std::call_once(once, [] {
    llvm::InitializeNativeTarget();
    llvm::InitializeNativeTargetAsmPrinter();
    // The emitter fixes the order of operations; passes that reorder them would examine every pair of loads and stores.
    set_option("enable-misched", "false");
    // With this option, quick code would be selected instruction by instruction, and would be slower.
    set_option("fast-isel", "false");
  });
  auto builder = Builder::detectHost();
  if (!builder) return void(message = text_of(builder.takeError()));
  // Compiles twice as fast as Default for long code, and the code is as fast; a simpler register allocator gains
  // nothing more.
  builder->setCodeGenOptLevel(llvm::CodeGenOptLevel::Less);
  builder->setRelocationModel(llvm::Reloc::PIC_);
  // Called functions may be anywhere and are reached by stubs; constants are beside the code and are operands.
  builder->setCodeModel(llvm::CodeModel::Small);

  // The code of a long plan is made once. Better code than requested is used if it is there.
  const std::size_t parts = Emitter::parts(tables);
  if (parts > 1) effort = CodeEffort::full;
  std::vector<Key> keys(parts);
  const auto named = [&](CodeEffort e) {
    bool all = !cache.empty();
    for (std::size_t part = 0; part < parts && all; ++part)
      all = name(tables, lanes, e, called.several, part, *builder, keys[part]);
    return all;
  };
  Objects objects;
  for (const CodeEffort e : {CodeEffort::full, effort}) {
    if (!named(e)) break;
    const Store store(cache);
    objects.clear();
    for (const Key& key : keys)
      if (auto kept = store.read(key)) objects.push_back(std::move(kept));
    if (objects.size() == parts) {
      std::string why;
      code = linked(std::move(objects), *builder, Emitter::levels(tables), called, why);
      code.effort = e;
      if (code.extend) return;
    }
    if (effort == e) break;
  }
  const Store store(named(effort) ? cache : std::string());
  objects = compiled_all(tables, lanes, effort, called.several, *builder, message);
  if (objects.empty()) return;
  for (std::size_t part = 0; part < parts; ++part) store.write(keys[part], *objects[part]);
  code = linked(std::move(objects), *builder, Emitter::levels(tables), called, message);
  code.effort = effort;
}

}  // namespace

}  // namespace anholon::jit

const anholon::CompilerModule anholon_compiler{anholon::kCompilerVersion, anholon::jit::compile};
const char anholon_compiler_layout[] = ANHOLON_KERNEL_LAYOUT;
