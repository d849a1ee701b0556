// Detects the kind of a user's JSON file from its top-level keys, so that messages name that kind, not a missing key.
#pragma once

#include <optional>
#include <string>

namespace furrow {

enum class FileKind { scenario, study, calibration, tire, soil, vehicle };

/// @tparam Json nlohmann::json or nlohmann::ordered_json; no other is compiled
/// @returns nothing if the keys do not show the kind
template <class Json>
std::optional<FileKind> kind_of_file(const Json& document);

/// A document that could be a scenario as well as a soil is accepted as either.
/// @throws Error(bad_input) if the document is of another kind: "is a soil, expected a tire (…)"
template <class Json>
void refuse_other_kinds(const Json& document, FileKind expected, const std::string& file);

}  // namespace furrow
