#include "table.h"

#include <cstdio>

namespace atrium::bench {

Table::Table(const std::vector<std::string>& head) {
  row(head);
  std::vector<std::string> rule(head.size(), "---:");
  rule[0] = "---";
  row(rule);
}

void Table::row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) text_ += "| " + cell + " ";
  text_ += "|\n";
}

std::string format(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string percent(double share) {
  return format(share < 0.00995 ? "%.2f %%" : "%.1f %%", 100.0 * share);
}

std::string short_count(double count) {
  if (count == 0.0) return "-";
  std::string text = format("%.1e", count);  // 2.4e+07
  const std::size_t e = text.find("e+0");
  if (e != std::string::npos) text.erase(e + 1, 2);
  return text;
}

}  // namespace atrium::bench
