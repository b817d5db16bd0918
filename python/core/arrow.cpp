// Columns of doubles and of texts as a stream of the Arrow C data interface
// (arrow.apache.org/docs/format/CStreamInterface.html): one batch, which reads the numbers where they are and keeps their
// owners alive.
#include <cstring>
#include <memory>
#include <variant>

#include <nanobind/stl/variant.h>

#include "core.h"

extern "C" {
struct ArrowSchema {
  const char *format, *name, *metadata;
  std::int64_t flags, n_children;
  ArrowSchema** children;
  ArrowSchema* dictionary;
  void (*release)(ArrowSchema*);
  void* private_data;
};
struct ArrowArray {
  std::int64_t length, null_count, offset, n_buffers, n_children;
  const void** buffers;
  ArrowArray** children;
  ArrowArray* dictionary;
  void (*release)(ArrowArray*);
  void* private_data;
};
struct ArrowArrayStream {
  int (*get_schema)(ArrowArrayStream*, ArrowSchema* out);
  int (*get_next)(ArrowArrayStream*, ArrowArray* out);
  const char* (*get_last_error)(ArrowArrayStream*);
  void (*release)(ArrowArrayStream*);
  void* private_data;
};
}

namespace anholon::python {

namespace {

using Doubles = nb::ndarray<nb::numpy, const double, nb::ndim<1>, nb::c_contig>;

// Texts one after the other, and the beginning of each; the last place is the end.
struct Texts {
  explicit Texts(const std::vector<std::string>& list) {
    for (const std::string& text : list) all += text, places.push_back(static_cast<std::int64_t>(all.size()));
  }
  std::string all;
  std::vector<std::int64_t> places = {0};
};
using Array = std::variant<Doubles, Texts>;

std::int64_t length_of(const Array& array) {
  const auto* texts = std::get_if<Texts>(&array);
  return texts ? static_cast<std::int64_t>(texts->places.size()) - 1
               : static_cast<std::int64_t>(std::get<Doubles>(array).shape(0));
}
std::vector<const void*> buffers_of(const Array& array) {
  if (const auto* texts = std::get_if<Texts>(&array)) return {nullptr, texts->places.data(), texts->all.data()};
  return {nullptr, std::get<Doubles>(array).data()};
}

// The columns of a stream, shared by the objects that the stream exports. The arrays are released with the
// interpreter's lock.
struct Columns {
  std::vector<std::string> names, units;
  std::vector<Array> arrays;
  ~Columns() {
    const nb::gil_scoped_acquire lock;
    arrays.clear();
  }
};
using Shared = std::shared_ptr<const Columns>;

// Returns metadata of a field in Arrow's encoding: the number of pairs, then each length and text.
std::string metadata(const std::string& key, const std::string& value) {
  std::string out;
  const auto put = [&](std::int32_t n) { out.append(reinterpret_cast<const char*>(&n), sizeof n); };
  put(1);
  for (const std::string& text : {key, value}) put(static_cast<std::int32_t>(text.size())), out += text;
  return out;
}

struct SchemaNode {
  std::string name, metadata;
  std::vector<ArrowSchema> fields;
  std::vector<ArrowSchema*> children;
};

void release_schema(ArrowSchema* schema) {
  auto* node = static_cast<SchemaNode*>(schema->private_data);
  for (ArrowSchema* child : node->children)
    if (child->release) child->release(child);
  delete node;
  schema->release = nullptr;
}

void fill(ArrowSchema& schema, const char* format, SchemaNode* node) {
  schema = {format,
            node->name.c_str(),
            node->metadata.empty() ? nullptr : node->metadata.c_str(),
            0,
            static_cast<std::int64_t>(node->children.size()),
            node->children.data(),
            nullptr,
            release_schema,
            node};
}

int get_schema(ArrowArrayStream* stream, ArrowSchema* out) {
  const Columns& columns = **static_cast<const Shared*>(stream->private_data);
  auto* root = new SchemaNode;
  root->fields.resize(columns.names.size());
  for (std::size_t k = 0; k < columns.names.size(); ++k) {
    auto* field = new SchemaNode;
    field->name = columns.names[k];
    if (!columns.units[k].empty()) field->metadata = metadata("unit", columns.units[k]);
    fill(root->fields[k], std::holds_alternative<Texts>(columns.arrays[k]) ? "U" : "g", field);
    root->children.push_back(&root->fields[k]);
  }
  fill(*out, "+s", root);
  return 0;
}

struct ArrayNode {
  Shared columns;
  std::vector<const void*> buffers;
  std::vector<ArrowArray> fields;
  std::vector<ArrowArray*> children;
};

void release_array(ArrowArray* array) {
  auto* node = static_cast<ArrayNode*>(array->private_data);
  for (ArrowArray* child : node->children)
    if (child->release) child->release(child);
  delete node;
  array->release = nullptr;
}

void fill(ArrowArray& array, std::int64_t length, ArrayNode* node) {
  array = {length,
           0,
           0,
           static_cast<std::int64_t>(node->buffers.size()),
           static_cast<std::int64_t>(node->children.size()),
           node->buffers.data(),
           node->children.data(),
           nullptr,
           release_array,
           node};
}

int get_next(ArrowArrayStream* stream, ArrowArray* out) {
  auto& shared = *static_cast<Shared*>(stream->private_data);
  if (!shared || shared->arrays.empty()) {
    std::memset(out, 0, sizeof *out);  // the end
    return 0;
  }
  const std::int64_t length = length_of(shared->arrays[0]);
  auto* root = new ArrayNode{shared, {nullptr}, std::vector<ArrowArray>(shared->arrays.size()), {}};
  for (std::size_t k = 0; k < shared->arrays.size(); ++k) {
    fill(root->fields[k], length, new ArrayNode{shared, buffers_of(shared->arrays[k]), {}, {}});
    root->children.push_back(&root->fields[k]);
  }
  fill(*out, length, root);
  auto rest = std::make_shared<Columns>();
  rest->names = shared->names, rest->units = shared->units;
  shared = std::move(rest);
  return 0;
}

void release_stream(ArrowArrayStream* stream) {
  delete static_cast<Shared*>(stream->private_data);
  stream->release = nullptr;
}

// Releases a stream that nobody has taken, with its capsule.
void release_capsule(void* stream_of_capsule) noexcept {
  auto* stream = static_cast<ArrowArrayStream*>(stream_of_capsule);
  if (stream->release) stream->release(stream);
  delete stream;
}

}  // namespace

void bind_arrow(nb::module_& m) {
  m.def(
      "arrow_stream",
      [](std::vector<std::string> names, std::vector<std::string> units,
         std::vector<std::variant<Doubles, std::vector<std::string>>> arrays) {
        auto columns = std::make_shared<Columns>();
        columns->names = std::move(names), columns->units = std::move(units);
        for (auto& array : arrays)
          if (auto* numbers = std::get_if<Doubles>(&array))
            columns->arrays.emplace_back(std::move(*numbers));
          else
            columns->arrays.emplace_back(Texts(std::get<std::vector<std::string>>(array)));
        auto* stream =
            new ArrowArrayStream{get_schema, get_next, [](ArrowArrayStream*) -> const char* { return nullptr; },
                                 release_stream, new Shared(std::move(columns))};
        return nb::capsule(stream, "arrow_array_stream", release_capsule);
      },
      "names"_a, "units"_a, "arrays"_a,
      "A capsule with an Arrow stream of columns of the same length, numbers or texts; units may be empty.");
}

}  // namespace anholon::python
