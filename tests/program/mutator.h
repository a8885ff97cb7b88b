// Damages files at random, the same way in every run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace beltrami::cli {

class Mutator {
 public:
  /// `pieces`: what is put in the place of words, or between them. `ends`: what ends a word.
  Mutator(std::vector<std::string> pieces, std::string ends)
      : pieces_(std::move(pieces)), ends_(std::move(ends)) {}

  std::string damaged(std::string text) {
    for (std::size_t n = 1 + below(4); n > 0; --n) damage(text);
    return text;
  }

 private:
  std::size_t below(std::size_t limit) { return random_() % std::max<std::size_t>(limit, 1); }

  void damage(std::string& text) {
    const std::size_t at = below(text.size()), length = below(1 + text.size() - at) % 40;
    switch (below(6)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random_());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 3:
        text.resize(at);
        break;
      case 4: {  // a number or a word becomes another one
        const std::size_t end = text.find_first_of(ends_, at);
        text.replace(at, end == std::string::npos ? length : end - at,
                     pieces_[below(pieces_.size())]);
        break;
      }
      default:
        text.insert(at, pieces_[below(pieces_.size())]);
    }
  }

  std::vector<std::string> pieces_;
  std::string ends_;
  std::mt19937_64 random_{15};
};

}  // namespace beltrami::cli
