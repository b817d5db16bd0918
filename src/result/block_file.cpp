#include "result/block_file.h"

#include <cstring>

#include <unistd.h>

namespace anholon {

namespace {

constexpr std::size_t kBlocks = 4;      // one is filled, the others wait or are written
constexpr int kBlocksOfSmallFiles = 8;  // a file with fewer needs no thread
constexpr std::size_t kRoom = 1u << 18;

}  // namespace

BlockFile::BlockFile(const std::string& path)
    : file_(path), failed_(!file_.error().empty()),
      blocks_(std::vector<Block>(kBlocks), [this](Block& block) { write(block); }) {
  // A block goes to the system by one call, without a copy in the buffer of the stream.
  if (file_.stream() && !file_.part().empty()) std::setvbuf(file_.stream(), nullptr, _IONBF, 0);
}

bool BlockFile::is_terminal() const { return file_.stream() && ::isatty(::fileno(file_.stream())); }

char* BlockFile::room(std::size_t bytes) {
  Block& b = blocks_.filling();
  if (b.text.size() - b.used < bytes) b.text.resize(b.used + bytes + kRoom);
  return b.text.data() + b.used;
}

void BlockFile::add(std::string_view text) {
  std::memcpy(room(text.size()), text.data(), text.size());
  added(text.size());
}

void BlockFile::write(Block& block) {
  file_.write({block.text.data(), block.used});
  file_.flush();
  block.used = 0;
  if (!file_.error().empty()) failed_ = true;
}

void BlockFile::end_block() {
  if (ended_ < kBlocksOfSmallFiles && ++ended_ == kBlocksOfSmallFiles) blocks_.work_beside();
  blocks_.pass_on();
}

void BlockFile::flush() {
  if (!file_.stream()) return;
  blocks_.pass_on();
  blocks_.settle();
}

std::string BlockFile::close() {
  flush();
  const std::string why = file_.close();
  failed_ = !why.empty();
  return why;
}

const std::string& BlockFile::error() const {
  static const std::string none;
  return failed_ ? file_.error() : none;
}

}  // namespace anholon
