#include "nodes/commands/wrapped.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string_view>

namespace furrow::commands {
namespace {

constexpr std::size_t kWidest = 120;       // columns of a readable text
constexpr std::size_t kNarrowest = 60;     // in narrower ones the terminal breaks the lines
constexpr std::size_t kSecondColumn = 40;  // a second column begins before this one

/// Columns of UTF-8 text: a character of several bytes counts once.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Column at which the rest of a line begins.
std::size_t hanging_indent(std::string_view line) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", first);
  const std::size_t second = gap == std::string_view::npos ? gap : line.find_first_not_of(' ', gap);
  return second < kSecondColumn ? second : first;
}

void append_wrapped(std::string& text, std::string_view line, std::size_t width) {
  if (columns(line) <= width) {
    text.append(line);
    return;
  }
  const std::size_t indent = hanging_indent(line);
  text.append(line.substr(0, indent));
  std::size_t column = columns(line.substr(0, indent));
  bool first = true;
  for (std::size_t from = indent, end; from < line.size(); from = end + 1) {
    end = std::min(line.find(' ', from), line.size());
    const std::string_view word = line.substr(from, end - from);
    if (!first && column + 1 + columns(word) > width) {
      text += "\n" + std::string(indent, ' ');
      column = indent;
      first = true;
    }
    if (!first) text += ' ', ++column;
    text.append(word);
    column += columns(word);
    first = false;
  }
}

/// Width of the terminal at standard output; 0: it is not a terminal.
std::size_t terminal_columns() {
  if (!isatty(STDOUT_FILENO)) return 0;
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0
             ? std::clamp<std::size_t>(size.ws_col, kNarrowest, kWidest)
             : kWidest;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t width) {
  std::string made;
  for (std::size_t from = 0, end; from < text.size(); from = end + 1) {
    end = std::min(text.find('\n', from), text.size());
    append_wrapped(made, std::string_view(text).substr(from, end - from), width);
    if (end < text.size()) made += '\n';
  }
  return made;
}

void print_text(const std::string& text, Piped piped) {
  const std::size_t terminal = terminal_columns();
  if (terminal == 0 && piped == Piped::whole_lines)
    std::cout << text;
  else
    std::cout << wrapped(text, terminal == 0 ? kWidest : terminal);
}

}  // namespace furrow::commands
