// Keys of the files that people write: the name, unit, allowed values and meaning of a field. A key is declared with
// its member, in the list of fields; its default is the member's initialiser:
//
//   struct GroundOptions {
//     double stiffness = 4e8;
//   };
//   void visit_fields(FieldsOf<GroundOptions> auto& s, auto&& visit) {
//     visit(s.stiffness, key("stiffness", "N/m³", allowed::above(0).to(1e15), "Pressure per depth."));
//   }
//
// From it follows the schema (protocol/files/key_schema.hpp), and with that checks, defaults, `furrow explain` and the
// help of editors.
#pragma once

#include <limits>

#include "protocol/core/fields.hpp"

namespace furrow {

namespace role {
inline constexpr unsigned by_hand = 1U << 5U;  // code that reads lists leaves this key to its caller
}  // namespace role

enum class Missing {
  standard,  // the member keeps its default
  nothing,   // none; there is no default
  mistake,   // the file is refused
};

/// The allowed values of a key, and its usual ones.
struct Allowed {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool above_low = false, below_high = false;  // the bounds themselves are not allowed
  double usual_low = 0.0, usual_high = 0.0;    // other magnitudes cause a warning; 0 and 0: all are usual
  int divisor = 1;                             // a whole number must be a multiple of it
  const char* texts = "";                      // the allowed texts, separated by blanks; empty: any text
  const char* shape = "";  // JSON entries of the schema that replace those derived from member and key
  Missing missing = Missing::standard;
  bool takes_null = false;  // null is allowed and is the default; the description states its meaning
  bool takes_empty = true;  // an empty text is allowed

 private:
  template <class Change>
  constexpr Allowed changed(const Change& change) const {  // before its uses: clang 14 needs it there
    Allowed other = *this;
    change(other);
    return other;
  }

 public:
  constexpr Allowed from(double least, double most = std::numeric_limits<double>::infinity()) const {
    return changed([&](Allowed& a) { a.low = least, a.high = most; });
  }
  constexpr Allowed above(double bound) const {
    return changed([&](Allowed& a) { a.low = bound, a.above_low = true; });
  }
  constexpr Allowed to(double most) const {
    return changed([&](Allowed& a) { a.high = most; });
  }
  constexpr Allowed below(double bound) const {
    return changed([&](Allowed& a) { a.high = bound, a.below_high = true; });
  }
  constexpr Allowed usual(double least, double most) const {
    return changed([&](Allowed& a) { a.usual_low = least, a.usual_high = most; });
  }
  constexpr Allowed multiple_of(int number) const {
    return changed([&](Allowed& a) { a.divisor = number; });
  }
  constexpr Allowed words(const char* list) const {
    return changed([&](Allowed& a) { a.texts = list; });
  }
  constexpr Allowed shaped(const char* json) const {
    return changed([&](Allowed& a) { a.shape = json; });
  }
  constexpr Allowed required() const {
    return changed([](Allowed& a) { a.missing = Missing::mistake; });
  }
  constexpr Allowed optional() const {
    return changed([](Allowed& a) { a.missing = Missing::nothing; });
  }
  constexpr Allowed or_null() const {
    return changed([](Allowed& a) { a.takes_null = true; });
  }
  constexpr Allowed not_empty() const {
    return changed([](Allowed& a) { a.takes_empty = false; });
  }
};

namespace allowed {
inline constexpr Allowed any;
constexpr Allowed from(double least, double most = any.high) { return any.from(least, most); }
constexpr Allowed above(double bound) { return any.above(bound); }
constexpr Allowed below(double bound) { return any.below(bound); }
constexpr Allowed words(const char* list) { return any.words(list); }
constexpr Allowed shaped(const char* json) { return any.shaped(json); }
constexpr Allowed required() { return any.required(); }
constexpr Allowed optional() { return any.optional(); }
constexpr Allowed not_empty() { return any.not_empty(); }
}  // namespace allowed

struct Key : Field, Allowed {
  const char* description = "";

  constexpr Key with(unsigned more) const {
    Key key = *this;
    key.roles |= more;
    return key;
  }
};

/// Name of a struct in the definitions of a schema, to which other structs refer; its static member kSchema.
struct SchemaName {
  const char* name;
  const char* description;
};

/// @param unit SI; "-" for a number without dimension, "" for a value that is not measured
constexpr Key key(const char* name, const char* unit, unsigned roles, const Allowed& values, const char* description) {
  return {{name, unit, roles | role::key}, values, description};
}
constexpr Key key(const char* name, const char* unit, const Allowed& values, const char* description) {
  return key(name, unit, role::key, values, description);
}
constexpr Key key(const char* name, const char* unit, unsigned roles, const char* description) {
  return key(name, unit, roles, allowed::any, description);
}
constexpr Key key(const char* name, const char* unit, const char* description) {
  return key(name, unit, allowed::any, description);
}
constexpr Key key(const char* name) { return key(name, "", allowed::any, ""); }

/// A key that every file must contain.
constexpr Key needed(const char* name, const char* unit, const Allowed& values, const char* description) {
  return key(name, unit, values.required(), description);
}
constexpr Key needed(const char* name, const char* unit, const char* description) {
  return key(name, unit, allowed::required(), description);
}
constexpr Key needed(const char* name) { return key(name, "", allowed::required(), ""); }

}  // namespace furrow
