// What a command says on standard error besides errors. --quiet silences it: errors, and how to continue after one, are
// always said.
#pragma once

#include <string>
#include <utility>

#include <fmt/format.h>

namespace furrow::launch {

/// Standard input, output and error that whoever started this process has closed are taken, so that no file of results
/// gets their place and what is printed. Writing to them fails as before.
void occupy_closed_streams();

/// --quiet: from here on this process says nothing but errors.
void silence_messages();
bool messages_are_silenced();

/// Writes `text`, whole lines, unless messages are silenced.
void say(const std::string& text);
template <class First, class... More>
void say(fmt::format_string<First, More...> text, First&& first, More&&... more) {
  say(fmt::format(text, std::forward<First>(first), std::forward<More>(more)...));
}

}  // namespace furrow::launch
