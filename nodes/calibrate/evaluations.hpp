// All predictions that a calibration asked for, by their parameters: the file evaluations.csv in its folder. A resumed
// calibration reads its earlier predictions from it, and so ends with the same bits.
//
//   # furrow calibrate 1 <digest of the study>
//   set,bending,shear,…,problem,values,errors,processor_s
//
// Numbers have 17 digits; blanks separate several numbers in a cell. The processor's time is empty if it was not
// measured.
#pragma once

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

inline constexpr const char* kEvaluations = "evaluations.csv";

class EvaluationTable {
 public:
  /// Reads the table of the folder, or begins one. Ignores a last line that was cut short.
  /// @param digest of the study @throws Error(bad_input) if the folder has the table of another study, Error(io)
  EvaluationTable(const std::filesystem::path& folder, const std::string& digest,
                  const std::vector<std::string>& parameters);

  /// @returns null if there is no such prediction @param state other values that the prediction depends on
  const Prediction* find(const std::string& state, std::span<const double> values) const;
  /// Adds a line and passes it to the system. @throws Error(io)
  const Prediction& add(const std::string& state, std::span<const double> values, Prediction prediction);
  std::size_t size() const { return known_.size(); }
  /// Processor time of all evaluations, including earlier ones, s.
  double processor_time() const;

 private:
  void read(const std::string& text, const std::string& head);
  void write(const std::string& text);

  std::filesystem::path file_;
  std::size_t parameters_;
  std::map<std::string, Prediction> known_;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> stream_;
};

}  // namespace furrow::calibrate
