// Every prediction that a calibration has asked for, by its parameters: the file evaluations.csv in its folder. A
// calibration that was interrupted takes from it what it computed before, and so ends with the same bits.
//
//   # furrow calibrate 1 <digest of the study>
//   set,bending,shear,…,problem,values,errors,processor_s
//
// Numbers have 17 digits; several of them have blanks between. The processor's time is left out where it is not told.
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
  /// Reads the table of the folder, or begins one. A last line that was cut short is left out.
  /// @param digest of the study @throws Error(bad_input) when it holds the table of another study, Error(io)
  EvaluationTable(const std::filesystem::path& folder, const std::string& digest,
                  const std::vector<std::string>& parameters);

  /// @returns null where it is not known @param state what the prediction depends on besides the parameters
  const Prediction* find(const std::string& state, std::span<const double> values) const;
  /// Adds a line and gives it to the system. @throws Error(io)
  const Prediction& add(const std::string& state, std::span<const double> values, Prediction prediction);
  std::size_t size() const { return known_.size(); }
  /// Of all evaluations, whenever they were made, s.
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
