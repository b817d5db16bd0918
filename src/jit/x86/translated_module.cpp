#include "jit/x86/translated_module.h"

#include <cstring>
#include <map>

#include <llvm/IR/LegacyPassManager.h>
#include <llvm/Pass.h>
#include <llvm/Transforms/Scalar.h>
#include <sys/mman.h>

#include "jit/x86/translator.h"

namespace anholon::jit::x86 {

namespace {

// Memory that is first written and then executed.
class Executable {
 public:
  explicit Executable(const std::vector<std::uint8_t>& bytes) : size_(bytes.size()) {
    void* place = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw Unknown("there is no memory for code");
    std::memcpy(place, bytes.data(), size_);
    if (mprotect(place, size_, PROT_READ | PROT_EXEC) != 0) {
      munmap(place, size_);
      throw Unknown("memory cannot be executed");
    }
    memory_ = static_cast<std::uint8_t*>(place);
  }
  Executable(const Executable&) = delete;
  Executable& operator=(const Executable&) = delete;
  ~Executable() { munmap(memory_, size_); }
  std::uint8_t* at(std::size_t place) const { return memory_ + place; }

 private:
  std::uint8_t* memory_ = nullptr;
  std::size_t size_;
};

void put(std::vector<std::uint8_t>& bytes, const Distance& d, std::size_t from, std::size_t to) {
  const std::int64_t distance = static_cast<std::int64_t>(to) - static_cast<std::int64_t>(from) - 4 - d.behind;
  if (distance < INT32_MIN || distance > INT32_MAX) throw Unknown("the code is too long");
  for (std::size_t k = 0; k < 4; ++k) bytes[from + k] = static_cast<std::uint8_t>(distance >> (8 * k));
}

constexpr std::size_t kAlign = 64;

void align(std::vector<std::uint8_t>& bytes) { bytes.resize((bytes.size() + kAlign - 1) / kAlign * kAlign, 0xcc); }

struct Placed {
  std::vector<std::uint8_t> bytes;
  std::map<std::string, std::size_t, std::less<>> places;
};

// Removes repeated computations, because the Emitter requests some numbers twice.
void compute_once(llvm::Module& module) {
  llvm::legacy::FunctionPassManager passes(&module);
  passes.add(llvm::createEarlyCSEPass());
  for (llvm::Function& f : module)
    if (!f.isDeclaration()) passes.run(f);
}

Placed translated(llvm::Module& module, Surroundings& around) {
  std::vector<llvm::Function*> functions;
  for (llvm::Function& f : module) {
    if (f.isDeclaration()) continue;
    around.functions[&f] = static_cast<int>(functions.size());
    functions.push_back(&f);
  }
  for (const llvm::GlobalVariable& table : module.globals()) around.tables[&table] = around.constants.table(table);
  Placed all;
  std::vector<std::size_t> begins;
  std::vector<Distance> constants, calls;
  for (llvm::Function* f : functions) {
    const Encoder code = Translator(*f, around).run();
    align(all.bytes);
    const std::size_t begin = all.bytes.size();
    begins.push_back(begin);
    all.places[std::string(f->getName())] = begin;
    all.bytes.insert(all.bytes.end(), code.bytes.begin(), code.bytes.end());
    for (Distance d : code.constants) d.at += begin, constants.push_back(d);
    for (Distance d : code.functions) d.at += begin, calls.push_back(d);
  }
  align(all.bytes);
  const std::size_t data = all.bytes.size();
  for (const std::uint64_t number : around.constants.all())
    for (int k = 0; k < 8; ++k) all.bytes.push_back(static_cast<std::uint8_t>(number >> (8 * k)));
  for (const Distance& d : constants) put(all.bytes, d, d.at, data + static_cast<std::size_t>(d.target));
  for (const Distance& d : calls) put(all.bytes, d, d.at, begins[static_cast<std::size_t>(d.target)]);
  return all;
}

}  // namespace

Code translated_module(llvm::Module& module, int levels, const CalledFunctions& called) {
  Surroundings around;
  called.for_each([&](const char* name, auto* function) {
    around.outside[name] = static_cast<std::int64_t>(reinterpret_cast<std::intptr_t>(function));
  });
  compute_once(module);
  const Placed all = translated(module, around);
  const auto memory = std::make_shared<Executable>(all.bytes);
  Code code;
  code.for_each_part(levels, [&](const std::string& name, auto& function) {
    const auto place = all.places.find(name);
    if (place == all.places.end()) throw Unknown("there is no " + name);
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(memory->at(place->second));
  });
  code.effort = CodeEffort::quick;
  code.translated = true;
  code.keeper = memory;
  return code;
}

}  // namespace anholon::jit::x86
