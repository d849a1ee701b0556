// Messages on standard error other than errors. --quiet silences them; errors, and how to continue after one, are
// always printed.
#pragma once

#include <string>
#include <utility>

#include <fmt/format.h>

namespace furrow::launch {

/// Opens standard input, output and error if the calling process closed them, so that no file of results takes their
/// place and receives printed text. Writing to them fails as before.
void occupy_closed_streams();

/// --quiet: from now on this process prints only errors.
void silence_messages();
bool messages_are_silenced();

/// Writes `text`, whole lines, unless messages are silenced.
void say(const std::string& text);
template <class First, class... More>
void say(fmt::format_string<First, More...> text, First&& first, More&&... more) {
  say(fmt::format(text, std::forward<First>(first), std::forward<More>(more)...));
}

}  // namespace furrow::launch
