// Keys of the files that people write: what a field is called, its unit, which values it takes, and what it means. A
// key is declared where its member is, in the list of fields; its default is the member's initialiser:
//
//   struct GroundOptions {
//     double stiffness = 4e8;
//   };
//   void visit_fields(FieldsOf<GroundOptions> auto& s, auto&& visit) {
//     visit(s.stiffness, key("stiffness", "N/m³", allowed::above(0).to(1e15), "Pressure per depth."));
//   }
//
// From it follow the schema (protocol/files/key_schema.hpp), and with that checks, defaults, `furrow explain` and
// editors.
#pragma once

#include <limits>

#include "protocol/core/fields.hpp"

namespace furrow {

namespace role {
inline constexpr unsigned by_hand = 1U << 5U;  // readers of lists leave the key to their caller
}  // namespace role

/// What a missing key means.
enum class Missing {
  standard,  // the member keeps its default
  nothing,   // nothing: there is no default
  mistake,   // the file is refused
};

/// Which values a key takes, and which are usual.
struct Allowed {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool above_low = false, below_high = false;  // the bounds themselves are not allowed
  double usual_low = 0.0, usual_high = 0.0;    // other magnitudes give a warning; 0 and 0: any is usual
  int divisor = 1;                             // of a whole number
  const char* texts = "";                      // with blanks between them; empty: any text
  const char* shape = "";  // entries of the schema in place of those that follow from member and key, JSON
  Missing missing = Missing::standard;
  bool takes_null = false;  // the default is null, whose meaning the description states
  bool takes_empty = true;  // text

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

 private:
  template <class Change>
  constexpr Allowed changed(const Change& change) const {
    Allowed other = *this;
    change(other);
    return other;
  }
};

namespace allowed {
inline constexpr Allowed any;
constexpr Allowed from(double least, double most = any.high) { return any.from(least, most); }
constexpr Allowed above(double bound) { return any.above(bound); }
constexpr Allowed to(double most) { return any.to(most); }
constexpr Allowed below(double bound) { return any.below(bound); }
constexpr Allowed words(const char* list) { return any.words(list); }
constexpr Allowed shaped(const char* json) { return any.shaped(json); }
constexpr Allowed required() { return any.required(); }
constexpr Allowed optional() { return any.optional(); }
constexpr Allowed or_null() { return any.or_null(); }
constexpr Allowed not_empty() { return any.not_empty(); }
}  // namespace allowed

struct Key : Field, Allowed {
  const char* description = "";

  /// The same key with more roles.
  constexpr Key with(unsigned more) const {
    Key key = *this;
    key.roles |= more;
    return key;
  }
};

/// What a struct is called in the definitions of a schema, as its static member kSchema: other structs refer to it.
struct SchemaName {
  const char* name;
  const char* description;
};

/// @param unit SI; "-" of a number without dimension, "" of what is not measured
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

/// A key that no file may lack.
constexpr Key needed(const char* name, const char* unit, const Allowed& values, const char* description) {
  return key(name, unit, values.required(), description);
}
constexpr Key needed(const char* name, const char* unit, const char* description) {
  return key(name, unit, allowed::required(), description);
}
constexpr Key needed(const char* name) { return key(name, "", allowed::required(), ""); }

}  // namespace furrow
