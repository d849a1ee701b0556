#include "nodes/calibrate/evaluations.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::calibrate {
namespace {

constexpr std::string_view kMark = "# furrow calibrate 1 ";

std::string numbers_text(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", value);
  return text;
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (std::size_t end = text.find(at); end != std::string_view::npos; end = text.find(at)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> values;
  if (text.empty()) return values;
  for (const std::string_view word : split(text, ' ')) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), values.emplace_back());
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  }
  return values;
}

std::string key_of(const std::string& state, std::span<const double> values) {
  std::string key = state;
  for (const double value : values) key += fmt::format(",{:.17g}", value);
  return key;
}

/// A problem as one cell, for users; nothing is compared with it.
std::string cell(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '"' || c == '\n' || c == '\r') c = c == ',' ? ';' : ' ';
  return text;
}

}  // namespace

EvaluationTable::EvaluationTable(const std::filesystem::path& folder, const std::string& digest,
                                 const std::vector<std::string>& parameters)
    : file_(folder / kEvaluations), parameters_(parameters.size()) {
  const std::string mark = std::string(kMark) + digest + "\n";
  const std::string head = fmt::format("set,{},problem,values,errors,processor_s\n", fmt::join(parameters, ","));
  std::error_code error;
  std::string text;
  if (std::filesystem::exists(file_, error)) {
    text = read_whole_file(file_);
    text.resize(text.rfind('\n') + 1);  // 0 if the file was cut short before the first line was complete
    if (!text.empty() && !text.starts_with(mark))
      throw input_error(folder.string(), "--out",
                        std::string(text.starts_with(kMark) ? "holds the evaluations of another calibration: its start "
                                                              "file, parameters, targets or program differ"
                                                            : "holds an evaluations.csv that no calibration wrote") +
                            ", expected a new folder or --overwrite");
    if (text.size() < mark.size() + head.size()) text.clear();
    if (!text.empty()) read(text.substr(mark.size()), head);
    std::filesystem::resize_file(file_, text.size(), error);
  }
  stream_.reset(std::fopen(file_.c_str(), "ae"));
  if (error || !stream_)
    throw io_error(file_.string(), "cannot be written: " + (error ? error.message() : std::strerror(errno)));
  if (text.empty()) write(mark + head);
}

void EvaluationTable::read(const std::string& text, const std::string& head) {
  const auto damaged = [this](const std::string& what) {
    return input_error(file_.string(), "", what + ", expected the file as furrow wrote it, or --overwrite");
  };
  if (!text.starts_with(head)) throw damaged("its columns are not those of this study");
  const std::vector<std::string_view> lines = split(text, '\n');
  for (std::size_t k = 1; k + 1 < lines.size(); ++k) {  // nothing follows the last line break
    const std::vector<std::string_view> cells = split(lines[k], ',');
    const std::size_t problem = parameters_ + 1;
    const auto number = [&](std::size_t after) {
      return problem + after < cells.size() ? numbers_of(cells[problem + after]) : std::nullopt;
    };
    const auto values = number(1), errors = number(2), time = number(3);
    if (cells.size() != problem + 4 || !values || !errors || !time || time->size() > 1)
      throw damaged(fmt::format("line {} is damaged", k + 2));
    const std::string key(cells.front().data(), cells[problem].data() - 1);
    known_[key] = {*values, *errors, std::string(cells[problem]), time->empty() ? 0.0 : time->front()};
  }
}

void EvaluationTable::write(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_.get()) != text.size() || std::fflush(stream_.get()) != 0)
    throw io_error(file_.string(), std::string("cannot be written: ") + std::strerror(errno));
}

const Prediction* EvaluationTable::find(const std::string& state, std::span<const double> values) const {
  const auto found = known_.find(key_of(state, values));
  return found == known_.end() ? nullptr : &found->second;
}

double EvaluationTable::processor_time() const {
  double sum = 0.0;
  for (const auto& [key, prediction] : known_) sum += prediction.processor_time;
  return sum;
}

const Prediction& EvaluationTable::add(const std::string& state, std::span<const double> values,
                                       Prediction prediction) {
  prediction.problem = cell(prediction.problem);
  const std::string key = key_of(state, values);
  write(fmt::format("{},{},{},{},{}\n", key, prediction.problem, numbers_text(prediction.values),
                    numbers_text(prediction.errors),
                    prediction.processor_time > 0.0 ? fmt::format("{:.3f}", prediction.processor_time) : ""));
  prediction.processor_time = std::round(1e3 * prediction.processor_time) / 1e3;
  return known_[key] = std::move(prediction);
}

}  // namespace furrow::calibrate
