// [[body]], [[particle]] and [[force]].
#pragma once
#include <functional>
#include <unordered_set>

#include "spec/names.h"

namespace anholon {

// Runs f and adds what it throws to the diagnostics (a silent failure only returns false). A failure that knows no
// place of its own is one of the element at `place`.
bool collect(Diagnostics& diagnostics, const std::function<void()>& f, Span place = {});

// The same for an element of the file; of a member of a family the message says which one it is, and one member speaks
// for all whose failure has the same place.
bool collect(Diagnostics& diagnostics, const std::function<void()>& f, const Item& element);
// Whether a failure of another member of the family was reported at its place.
bool is_repeated(const Diagnostics& diagnostics, const Diagnostic& d);

// Calls f(table, index) for each element of an array of tables, collecting failures per element.
void for_each_table(const Item& list, const std::string& what, Diagnostics& diagnostics,
                    const std::function<void(const Item&, std::size_t)>& f);

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
  void check_position(const Vector& place, const Item& item, const std::string& what);
  void check_inertia(const Body& body, const Expr (&moment)[3][3], Span span);

  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
  std::vector<Entry> entries_;
  std::unordered_set<NodeId> position_nodes_;  // that hold nothing a position may not
};

// The value of an expression of parameters and numbers; nothing if it depends on anything else.
std::optional<double> constant_value(const Model& model, Expr e);

}  // namespace anholon
