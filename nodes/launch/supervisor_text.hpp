// Separates the important lines of mpirun's standard error from its noise.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::launch {

/// A rank that ended by a signal, as mpirun reported it.
struct LostRank {
  int rank = 0;
  int signal = 0;
};

class LauncherText {
 public:
  void add(std::string_view line);

  const std::optional<LostRank>& lost() const { return lost_; }
  /// The line that reports a precondition of the program that did not hold; "" if there is none.
  const std::string& fault() const { return fault_; }
  /// The other text without ruled lines, in one line, its usual sentences last; for failures to start.
  std::string words() const;

 private:
  std::optional<LostRank> lost_;
  std::string fault_;
  std::string begun_;  // a sentence on a rank that died, whose end is on the next line
  std::vector<std::string> lines_, usual_;
  bool is_usual_ = false;  // for the current paragraph
};

}  // namespace furrow::launch
