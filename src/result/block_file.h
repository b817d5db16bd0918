// A growing file to which text is added in blocks. After some blocks another thread writes them, in their order, so
// that the thread that makes the text does not wait for the system.
#pragma once
#include <atomic>
#include <string>
#include <string_view>

#include "base/in_order.h"
#include "result/file.h"

namespace anholon {

class BlockFile {
 public:
  // An empty path or "-" is the standard output. Check `error` before use.
  explicit BlockFile(const std::string& path);
  // Writes the text so far to the file.
  ~BlockFile() { flush(); }

  bool open() const { return file_.stream() && error().empty(); }
  bool is_terminal() const;

  // Returns room for this many bytes after the text of the present block. `added` tells how many were used.
  char* room(std::size_t bytes);
  void added(std::size_t bytes) { blocks_.filling().used += bytes; }
  void add(std::string_view text);
  // The size of the text in the block.
  std::size_t waiting() { return blocks_.filling().used; }
  // Ends the block: it is written, at once or soon.
  void end_block();
  // Ends the block; after this call, all text is in the file, whatever happens to the program.
  void flush();
  // Returns an empty string, or the reason of a failure; the text written then stays in NAME.part.
  std::string close();
  // Empty, or the reason of the first failure.
  const std::string& error() const;
  // The path of the unfinished file; empty if there is none.
  std::string part() const { return file_.part(); }

 private:
  struct Block {
    std::string text;  // the first `used` characters; the others are room
    std::size_t used = 0;
  };
  void write(Block& block);

  GrowingFile file_;
  std::atomic<bool> failed_{false};
  int ended_ = 0;  // blocks, up to the one with which the other thread begins
  InOrder<Block> blocks_;
};

}  // namespace anholon
