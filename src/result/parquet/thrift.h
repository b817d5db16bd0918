// Thrift's compact protocol, in which the metadata of a Parquet file is written.
// (Apache Thrift, "Thrift compact protocol encoding")
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace anholon::thrift {

enum class Type : std::uint8_t {
  stop = 0,
  yes = 1,
  no = 2,
  byte = 3,
  i16 = 4,
  i32 = 5,
  i64 = 6,
  real = 7,
  binary = 8,
  list = 9,
  set = 10,
  map = 11,
  structure = 12,
};

// Appends values to a text. The fields of a structure are given by ascending numbers.
class Writer {
 public:
  const std::string& text() const { return text_; }

  Writer& i32(int field, std::int64_t value) { return integer(field, Type::i32, value); }
  Writer& i64(int field, std::int64_t value) { return integer(field, Type::i64, value); }
  Writer& binary(int field, std::string_view value);
  // Begins a list of structures or numbers, whose elements follow one by one.
  Writer& list(int field, Type elements, std::size_t size);
  // Elements of a list.
  Writer& element(std::int64_t value);
  Writer& element(std::string_view value);
  // Begins a field or an element that is a structure, which ends at `close`.
  Writer& open(int field);
  Writer& open_element();
  Writer& close();

 private:
  Writer& integer(int field, Type type, std::int64_t value);
  void header(int field, Type type);
  void varint(std::uint64_t value);
  std::string text_;
  std::string outer_;  // the last field numbers of the structures around
  int last_ = 0;       // number of the last field
};

// Reads values one after the other. A damaged value makes `good` false, and everything read after it is 0.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool good() const { return good_; }
  std::size_t at() const { return at_; }

  struct Field {
    int number = 0;
    Type type = Type::stop;
  };
  // Begins a structure; `next` gives its fields, the last of which is `stop`.
  void open();
  Field next();
  std::int64_t integer();
  std::string_view binary();
  struct List {
    Type elements = Type::stop;
    std::size_t size = 0;
  };
  List list();
  // Skips a value of this type.
  void skip(Type type, int depth = 0);

 private:
  std::uint64_t varint();
  std::uint8_t byte();
  std::string_view text_;
  std::size_t at_ = 0;
  bool good_ = true;
  std::string outer_;
  int last_ = 0;
};

// Calls f(field) for each field of a structure; f returns false for a field that is skipped.
template <class F>
void fields(Reader& r, const F& f) {
  r.open();
  for (Reader::Field field = r.next(); field.type != Type::stop && r.good(); field = r.next())
    if (!f(field)) r.skip(field.type);
}

// Calls f(k) for each element of a list; f has to read the element.
template <class F>
void elements(Reader& r, const F& f) {
  const Reader::List list = r.list();
  for (std::size_t k = 0; k < list.size && r.good(); ++k) f(k);
}

}  // namespace anholon::thrift
