// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/mrclam_data.hpp"

#include <functional>

#include "experiment/files/line_reader.hpp"

namespace experiment {

namespace {

constexpr double max_mrclam_time_s = 1e11;
constexpr double max_mrclam_number = 1e6;
constexpr int max_mrclam_subject = 1000;
constexpr int max_mrclam_barcode = 1'000'000;

/// Passes each row with `count` columns, or more.
void read_mrclam_rows(std::string_view text, const std::string& file, std::size_t count,
                      const std::function<void(const LineReader&, const std::vector<Word>&)>& row) {
  LineReader reader(text, file);
  while (reader.next()) {
    const std::vector<Word> words = reader.split_at_spaces();
    if (words.empty() || words.front().text.starts_with('#')) continue;
    if (words.size() < count)
      reader.fail(1, "must have " + std::to_string(count) + " columns, got " + std::to_string(words.size()));
    row(reader, words);
  }
}

double mrclam_number(const LineReader& reader, const Word& word, const char* what) {
  return reader.number_of(word, -max_mrclam_number, max_mrclam_number, what);
}

int mrclam_subject(const LineReader& reader, const Word& word) {
  return static_cast<int>(reader.whole_of(word, 1, max_mrclam_subject, "a subject"));
}

/// Reads the time of a row.
template <typename Row>
double mrclam_time(const LineReader& reader, const Word& word, const std::vector<Row>& before) {
  const double time_s = reader.number_of(word, 0, max_mrclam_time_s, "a time");
  if (!before.empty() && time_s < before.back().time_s) reader.fail(word, "times must not decrease");
  return time_s;
}

}  // namespace

std::map<int, int> parse_mrclam_barcodes(std::string_view text, const std::string& file) {
  std::map<int, int> subjects;
  read_mrclam_rows(text, file, 2, [&](const LineReader& reader, const std::vector<Word>& words) {
    const auto barcode = static_cast<int>(reader.whole_of(words[1], 0, max_mrclam_barcode, "a barcode"));
    if (!subjects.emplace(barcode, mrclam_subject(reader, words[0])).second)
      reader.fail(words[1], "each barcode must be of one subject");
  });
  return subjects;
}

std::vector<MrclamData::Landmark> parse_mrclam_landmarks(std::string_view text, const std::string& file) {
  std::vector<MrclamData::Landmark> landmarks;
  read_mrclam_rows(text, file, 3, [&](const LineReader& reader, const std::vector<Word>& words) {
    const int subject = mrclam_subject(reader, words[0]);
    for (const MrclamData::Landmark& other : landmarks)
      if (other.subject == subject) reader.fail(words[0], "each landmark must have one row");
    landmarks.push_back({subject, mrclam_number(reader, words[1], "x"), mrclam_number(reader, words[2], "y")});
  });
  return landmarks;
}

std::vector<MrclamData::Pose> parse_mrclam_truth(std::string_view text, const std::string& file) {
  std::vector<MrclamData::Pose> truth;
  read_mrclam_rows(text, file, 4, [&](const LineReader& reader, const std::vector<Word>& words) {
    const double time_s = mrclam_time(reader, words[0], truth);
    truth.push_back({time_s, mrclam_number(reader, words[1], "x"), mrclam_number(reader, words[2], "y"),
                     mrclam_number(reader, words[3], "an orientation")});
  });
  if (truth.empty()) LineReader(text, file).fail(1, "must have a pose");
  return truth;
}

std::vector<MrclamData::Odometry> parse_mrclam_odometry(std::string_view text, const std::string& file) {
  std::vector<MrclamData::Odometry> odometry;
  read_mrclam_rows(text, file, 3, [&](const LineReader& reader, const std::vector<Word>& words) {
    const double time_s = mrclam_time(reader, words[0], odometry);
    odometry.push_back({time_s, mrclam_number(reader, words[1], "a velocity"),
                        mrclam_number(reader, words[2], "an angular velocity")});
  });
  return odometry;
}

void parse_mrclam_measurements(std::string_view text, const std::string& file, const std::map<int, int>& subjects,
                               MrclamData::Robot& robot) {
  read_mrclam_rows(text, file, 4, [&](const LineReader& reader, const std::vector<Word>& words) {
    const double time_s = mrclam_time(reader, words[0], robot.measurements);
    const auto subject = subjects.find(static_cast<int>(reader.whole_of(words[1], 0, max_mrclam_barcode, "a barcode")));
    const MrclamData::Measurement measurement{time_s, subject == subjects.end() ? 0 : subject->second,
                                              reader.number_of(words[2], 0, max_mrclam_number, "a range"),
                                              mrclam_number(reader, words[3], "a bearing")};
    // The data sets have barcodes that were misread; they are counted and dropped.
    if (subject == subjects.end())
      ++robot.unknown_barcodes;
    else
      robot.measurements.push_back(measurement);
  });
}

}  // namespace experiment
