// Checks of refusals: the message of an Error, compared by its parts.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <source_location>
#include <string>
#include <vector>

#include "protocol/core/error.hpp"

namespace furrow {

/// Whether `text` contains `part`.
inline ::testing::AssertionResult holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << part << "' is not in: " << text;
}

/// The message of the Error that `work` throws, with the code `code`; empty if it throws none.
inline std::string refusal(ExitCode code, const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  return "";
}

/// A message without the name of its file: the text after "f.json: ", or the place in "f.json:3:7: …".
inline std::string without_file(const std::string& text, const std::string& file) {
  if (text.empty()) return text;
  EXPECT_TRUE(text.starts_with(file + ":")) << text;
  const std::string rest = text.substr(std::min(text.size(), file.size() + 1));
  return rest.starts_with(' ') ? rest.substr(1) : rest;
}

/// Checks that `work` throws an Error with this code and every part in its message.
inline void expect_refused(ExitCode code, const std::vector<std::string>& parts, const std::function<void()>& work,
                           std::source_location here = std::source_location::current()) {
  const ::testing::ScopedTrace trace(here.file_name(), static_cast<int>(here.line()), "was to be refused");
  const std::string text = refusal(code, work);
  EXPECT_NE(text, "");
  for (const std::string& part : parts) EXPECT_TRUE(holds(text, part));
}

}  // namespace furrow
