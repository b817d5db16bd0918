#include "result/parquet/thrift.h"

namespace anholon::thrift {

namespace {

constexpr int kDeepest = 16;  // structures within structures

std::uint64_t zigzag(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}

std::int64_t from_zigzag(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

}  // namespace

void Writer::varint(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) text_ += static_cast<char>((value & 0x7f) | 0x80);
  text_ += static_cast<char>(value);
}

void Writer::header(int field, Type type) {
  const int step = field - last_;
  if (step > 0 && step < 16) {
    text_ += static_cast<char>(step << 4 | static_cast<int>(type));
  } else {
    text_ += static_cast<char>(type);
    varint(zigzag(field));
  }
  last_ = field;
}

Writer& Writer::integer(int field, Type type, std::int64_t value) {
  header(field, type);
  varint(zigzag(value));
  return *this;
}

Writer& Writer::binary(int field, std::string_view value) {
  header(field, Type::binary);
  return element(value);
}

Writer& Writer::list(int field, Type elements, std::size_t size) {
  constexpr std::size_t kShort = 15;
  header(field, Type::list);
  const auto type = static_cast<std::size_t>(elements);
  text_ += static_cast<char>((size < kShort ? size : kShort) << 4 | type);
  if (size >= kShort) varint(size);
  return *this;
}

Writer& Writer::element(std::int64_t value) {
  varint(zigzag(value));
  return *this;
}

Writer& Writer::element(std::string_view value) {
  varint(value.size());
  text_ += value;
  return *this;
}

Writer& Writer::open(int field) {
  header(field, Type::structure);
  return open_element();
}

Writer& Writer::open_element() {
  outer_ += static_cast<char>(last_);
  last_ = 0;
  return *this;
}

Writer& Writer::close() {
  text_ += static_cast<char>(Type::stop);
  if (!outer_.empty()) {
    last_ = outer_.back();
    outer_.pop_back();
  }
  return *this;
}

std::uint8_t Reader::byte() {
  if (at_ >= text_.size()) good_ = false;
  return good_ ? static_cast<std::uint8_t>(text_[at_++]) : 0;
}

std::uint64_t Reader::varint() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint8_t b = byte();
    value |= static_cast<std::uint64_t>(b & 0x7f) << shift;
    if (b < 0x80) return good_ ? value : 0;
  }
  good_ = false;
  return 0;
}

void Reader::open() {
  outer_ += static_cast<char>(last_);
  last_ = 0;
}

Reader::Field Reader::next() {
  const std::uint8_t b = byte();
  const Type type = static_cast<Type>(b & 0x0f);
  if (!good_ || type == Type::stop || type > Type::structure) {
    good_ = good_ && type == Type::stop;
    if (!outer_.empty()) {
      last_ = outer_.back();
      outer_.pop_back();
    }
    return {};
  }
  const int step = b >> 4;
  last_ = step ? last_ + step : static_cast<int>(from_zigzag(varint()));
  if (last_ < 0 || last_ > 127) good_ = false;
  return {last_, type};
}

std::int64_t Reader::integer() { return from_zigzag(varint()); }

std::string_view Reader::binary() {
  const std::uint64_t size = varint();
  if (size > text_.size() - at_) good_ = false;
  if (!good_) return {};
  const std::string_view out = text_.substr(at_, size);
  at_ += size;
  return out;
}

Reader::List Reader::list() {
  const std::uint8_t b = byte();
  List out{static_cast<Type>(b & 0x0f), static_cast<std::size_t>(b >> 4)};
  if (out.size == 15) out.size = varint();
  if (out.size > text_.size() - at_) good_ = false;  // an element takes at least one byte
  return good_ ? out : List{};
}

void Reader::skip(Type type, int depth) {
  if (depth > kDeepest) good_ = false;
  if (!good_) return;
  switch (type) {
  case Type::stop:
  case Type::yes:
  case Type::no:
    return;
  case Type::byte:
    byte();
    return;
  case Type::i16:
  case Type::i32:
  case Type::i64:
    varint();
    return;
  case Type::real:
    for (int k = 0; k < 8; ++k) byte();
    return;
  case Type::binary:
    binary();
    return;
  case Type::list:
  case Type::set: {
    const List l = list();
    for (std::size_t k = 0; k < l.size && good_; ++k) {
      if (l.elements == Type::yes || l.elements == Type::no)
        byte();
      else
        skip(l.elements, depth + 1);
    }
    return;
  }
  case Type::map:
    good_ = false;  // the metadata of Parquet contains no maps
    return;
  case Type::structure:
    open();
    for (Field f = next(); f.type != Type::stop && good_; f = next()) skip(f.type, depth + 1);
    return;
  }
}

}  // namespace anholon::thrift
