// What a user's JSON file is, by the keys at its top: one of another kind is told by its kind, not by a key it lacks.
#pragma once

#include <optional>
#include <string>

namespace furrow {

enum class FileKind { scenario, study, calibration, tire, soil, vehicle };

/// @tparam Json nlohmann::json or nlohmann::ordered_json; no other is compiled
/// @returns nothing where the keys do not tell
template <class Json>
std::optional<FileKind> kind_of_file(const Json& document);

/// A scenario may say no more than a soil does: neither is refused as the other then.
/// @throws Error(bad_input) where the document is of another kind: "is a soil, expected a tire (…)"
template <class Json>
void refuse_other_kinds(const Json& document, FileKind expected, const std::string& file);

}  // namespace furrow
