#include "protocol/files/printable.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/files/text_file.hpp"

namespace furrow {
namespace {

/// Code point of the character of `length` bytes at `at`.
unsigned code_at(const std::string& text, std::size_t at, std::size_t length) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
  if (length == 1) return byte(0);
  unsigned code = byte(0) & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) code = code << 6 | (byte(k) & 0x3FU);
  return code;
}

/// Whether a terminal would obey the character instead of showing it: controls, line separators, direction of writing.
bool is_command(unsigned code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

std::string written_out(unsigned code) {
  switch (code) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return code < 0x80 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
  }
}

}  // namespace

std::string printable(const std::string& text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at++]));
      continue;
    }
    if (const unsigned code = code_at(text, at, length); is_command(code))
      shown += written_out(code);
    else
      shown.append(text, at, length);
    at += length;
  }
  return shown;
}

std::string excerpt(const std::string& text, std::size_t most) {
  // A printed character has at least as many bytes as the original, so `most + 4` bytes of the text are enough.
  const bool more = text.size() > most;
  std::string shown = printable(more ? text.substr(0, most + 4) : text);
  if (!more && shown.size() <= most) return shown;
  std::size_t cut = std::min(shown.size(), most - 3);
  while (cut > 0 && (static_cast<unsigned char>(shown[cut]) & 0xC0U) == 0x80U) --cut;
  return shown.substr(0, cut) + "…";
}

}  // namespace furrow
