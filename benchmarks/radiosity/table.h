#pragma once

#include <string>
#include <vector>

namespace atrium::bench {

/// A table in Markdown; all columns but the first are aligned right.
class Table {
 public:
  explicit Table(const std::vector<std::string>& head);
  void row(const std::vector<std::string>& cells);
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

[[nodiscard]] std::string format(const char* pattern, double value);
[[nodiscard]] std::string percent(double share);      ///< "1.23 %"
[[nodiscard]] std::string short_count(double count);  ///< "2.4e7"; "-" for 0

}  // namespace atrium::bench
