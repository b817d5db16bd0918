// [[body]], [[particle]] and [[force]].
#pragma once
#include <unordered_set>

#include "modelfile/names/names.h"

namespace anholon {

class BodyReader {
 public:
  BodyReader(Scope& scope, Model& model, Diagnostics& diagnostics)
      : scope_(scope), model_(model), diagnostics_(diagnostics) {}
  void declare(const Item& root);
  void read();
  void read_forces(const Item& root);

 private:
  struct Entry {
    const Item* item;
    bool particle;
    std::size_t index;
  };
  void read_body(const Entry& entry);
  void read_axes(Body& body, const Item* inertia, const Item* axes);
  void shape_axes(Body& body, Expr mass, Span span);
  void add_axis(Body& body, Expr weight, const Column& own, const std::string& tag, Span span);
  void read_force(const Item& item, std::size_t number);
  Expr frozen(Expr value, const std::string& name, Span span);
  Force::Place place(const Item& item);
  void check_jumps(Expr position, const Item& item, const std::string& what);
  void check_position(const Vector& place, const Item& item, const std::string& what);
  void check_inertia(const Body& body, const Expr (&moment)[3][3], Span span, const std::string& of_plane);

  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
  std::vector<Entry> entries_;
  std::unordered_set<NodeId> position_nodes_;  // nodes without anything that a position may not contain
};

}  // namespace anholon
