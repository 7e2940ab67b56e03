// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a text by std::from_chars and nothing else: what a reader of text is measured against.
// Prints the CPU seconds that it takes, without reading the file.
#include <charconv>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>

int main(int, char** argv) {
  std::ifstream file(argv[1], std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::clock_t start = std::clock();
  double sum = 0;
  for (const char *at = text.data(), *const end = at + text.size(); at < end;) {
    double value = 0;
    if ((*at >= '0' && *at <= '9') || *at == '-') {
      const auto [stop, error] = std::from_chars(at, end, value);
      at = stop + 1;
      sum += value;
    } else {
      ++at;
    }
  }
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("%.6f\n", seconds);
  return sum == 0.12345 ? 1 : 0;  // the sum is used, so that nothing is left out
}
