#include "nodes/calibrate/evaluations.hpp"

#include <algorithm>
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

std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> values;
  while (!text.empty()) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return std::nullopt;
    values.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) break;
    if (text.front() != ' ') return std::nullopt;
    text.remove_prefix(1);
  }
  return values;
}

std::string key_of(const std::string& state, std::span<const double> values) {
  std::string key = state;
  for (const double value : values) key += fmt::format(",{:.17g}", value);
  return key;
}

/// A problem as one cell: it is for people, and is compared with nothing.
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
    if (text.find('\n') == std::string::npos) text.clear();  // cut short before the first line was whole
    if (!text.empty() && !text.starts_with(mark))
      throw input_error(folder.string(), "--out",
                        std::string(text.starts_with(kMark)
                                        ? "holds the evaluations of another calibration: its start file, parameters, "
                                          "targets or program differ"
                                        : "holds an evaluations.csv that no calibration wrote") +
                            ", expected a new folder or --overwrite");
  }
  const std::size_t whole = text.empty() ? 0 : text.rfind('\n') + 1;
  text.resize(whole);
  if (whole > 0) {
    if (text.size() >= mark.size() + head.size())
      read(text.substr(mark.size()), head);
    else
      text.clear();
  }
  stream_.reset(std::fopen(file_.c_str(), text.empty() ? "we" : "r+e"));
  if (!stream_) throw io_error(file_.string(), std::string("cannot be written: ") + std::strerror(errno));
  if (text.empty()) {
    write(mark + head);
  } else {
    std::filesystem::resize_file(file_, text.size(), error);
    if (error || std::fseek(stream_.get(), 0, SEEK_END) != 0)
      throw io_error(file_.string(), "cannot be written from its last whole line on");
  }
}

void EvaluationTable::read(const std::string& text, const std::string& head) {
  const auto damaged = [this](const std::string& what) {
    return input_error(file_.string(), "", what + ", expected the file as furrow wrote it, or --overwrite");
  };
  if (!text.starts_with(head)) throw damaged("its columns are not those of this study");
  int number = 2;
  for (std::size_t at = head.size(), end; at < text.size(); at = end + 1) {
    end = text.find('\n', at);
    const std::string_view line = std::string_view(text).substr(at, end - at);
    ++number;
    std::vector<std::string_view> cells;
    for (std::size_t from = 0;;) {
      const std::size_t comma = line.find(',', from);
      cells.push_back(line.substr(from, comma == std::string_view::npos ? comma : comma - from));
      if (comma == std::string_view::npos) break;
      from = comma + 1;
    }
    if (cells.size() != parameters_ + 5) throw damaged(fmt::format("line {} is damaged", number));
    std::vector<double> values;
    for (std::size_t k = 0; k < parameters_; ++k) {
      const auto one = numbers_of(cells[k + 1]);
      if (!one || one->size() != 1) throw damaged(fmt::format("line {} is damaged", number));
      values.push_back(one->front());
    }
    const auto found = numbers_of(cells[parameters_ + 2]), errors = numbers_of(cells[parameters_ + 3]),
               time = numbers_of(cells[parameters_ + 4]);
    if (!found || !errors || !time || time->size() > 1) throw damaged(fmt::format("line {} is damaged", number));
    known_[key_of(std::string(cells[0]), values)] = {*found, *errors, std::string(cells[parameters_ + 1]),
                                                     time->empty() ? 0.0 : time->front()};
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
