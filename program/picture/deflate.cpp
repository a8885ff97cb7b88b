#include "picture/deflate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace beltrami::cli {
namespace {

/// Bytes that share a table of codes: it takes some hundred bytes.
constexpr std::size_t kBlock = 1 << 17;
constexpr std::size_t kLiterals = 286, kEnd = 256;
/// Repetitions are as long as these, or single bytes (RFC 1951, 3.2.5).
constexpr std::size_t kLeastRun = 3, kLongestRun = 258;
constexpr int kLongestCode = 15, kLongestCodeOfLengths = 7;

class Bits {
 public:
  void put(std::uint32_t bits, int count) {
    held_ |= std::uint64_t{bits} << count_;
    count_ += count;
    for (; count_ >= 8; count_ -= 8, held_ >>= 8) bytes_ += static_cast<char>(held_ & 0xFF);
  }
  std::string take() {
    if (count_ > 0) put(0, 8 - count_);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
  std::uint64_t held_ = 0;
  int count_ = 0;
};

/// Lengths of a prefix code for counted symbols, none longer than `longest`. Huffman's lengths are
/// cut there, and others are changed until all words have a meaning again (Kraft's sum is 1).
std::vector<int> code_lengths(const std::vector<std::uint32_t>& counts, int longest) {
  std::vector<std::pair<std::uint64_t, std::size_t>> heap;  // count, node
  std::vector<std::size_t> parent(counts.size(), 0);
  const auto later = [](const auto& a, const auto& b) { return a > b; };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) heap.emplace_back(counts[i], i);
  }
  std::vector<int> lengths(counts.size(), 0);
  if (heap.size() < 2) {  // a code of one symbol takes a bit, too
    for (const auto& [count, symbol] : heap) lengths[symbol] = 1;
    return lengths;
  }
  std::make_heap(heap.begin(), heap.end(), later);
  const auto pop = [&] {
    std::pop_heap(heap.begin(), heap.end(), later);
    const auto least = heap.back();
    heap.pop_back();
    return least;
  };
  while (heap.size() > 1) {
    const auto a = pop(), b = pop();
    const std::size_t node = parent.size();
    parent.push_back(0);
    parent[a.second] = parent[b.second] = node;
    heap.emplace_back(a.first + b.first, node);
    std::push_heap(heap.begin(), heap.end(), later);
  }
  const std::size_t root = parent.size() - 1;
  std::vector<int> depth(parent.size(), 0);
  for (std::size_t node = root; node-- > 0;) depth[node] = depth[parent[node]] + 1;
  std::vector<std::size_t> symbols;
  std::int64_t excess = -(std::int64_t{1} << longest);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    lengths[i] = std::min(depth[i], longest);
    excess += std::int64_t{1} << (longest - lengths[i]);
    symbols.push_back(i);
  }
  std::stable_sort(symbols.begin(), symbols.end(),
                   [&](std::size_t a, std::size_t b) { return counts[a] < counts[b]; });
  const auto step_of = [&](std::size_t symbol) {  // what a bit more or less of a length weighs
    return std::int64_t{1} << (longest - lengths[symbol]);
  };
  for (std::size_t k = 0; excess > 0; k = k + 1 < symbols.size() ? k + 1 : 0) {
    if (lengths[symbols[k]] >= longest) continue;
    excess -= step_of(symbols[k]) / 2;
    ++lengths[symbols[k]];
  }
  // Readers refuse a code that leaves words without a meaning: frequent symbols become shorter.
  for (std::size_t k = symbols.size(); excess<0; k = k> 1 ? k - 1 : symbols.size()) {
    const std::size_t symbol = symbols[k - 1];
    if (lengths[symbol] == 1 || step_of(symbol) > -excess) continue;
    excess += step_of(symbol);
    --lengths[symbol];
  }
  return lengths;
}

/// The codes of a canonical code, bits in the order in which they are written.
std::vector<std::uint32_t> codes_of(const std::vector<int>& lengths) {
  std::array<std::uint32_t, kLongestCode + 2> next{};
  for (const int length : lengths) {
    if (length > 0) ++next[static_cast<std::size_t>(length) + 1];
  }
  std::uint32_t code = 0;
  for (std::size_t length = 1; length < next.size(); ++length) {
    code = (code + next[length]) << 1;
    next[length] = code;
  }
  std::vector<std::uint32_t> codes(lengths.size(), 0);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    std::uint32_t forward = lengths[i] > 0 ? next[static_cast<std::size_t>(lengths[i])]++ : 0;
    for (int k = 0; k < lengths[i]; ++k, forward >>= 1) codes[i] = codes[i] << 1 | (forward & 1);
  }
  return codes;
}

/// The symbol of the length of a run, how many bits follow, and what they are.
struct RunCode {
  std::size_t symbol = 0;
  int extra = 0;
  std::uint32_t bits = 0;
};

RunCode run_code(std::size_t length) {
  if (length == kLongestRun) return {285, 0, 0};
  const std::size_t offset = length - kLeastRun;
  if (offset < 8) return {257 + offset, 0, 0};
  int extra = 1;
  while (offset >> (extra + 3) > 0) ++extra;
  const std::size_t step = offset >> extra;  // from 4 to 7
  return {257 + 4 * (static_cast<std::size_t>(extra) + 1) + step - 4, extra,
          static_cast<std::uint32_t>(offset & ((std::size_t{1} << extra) - 1))};
}

/// Calls literal(byte) and run(length) for the parts of a block.
template <class Literal, class Run>
void visit_parts(std::string_view block, const Literal& literal, const Run& run) {
  for (std::size_t at = 0; at < block.size();) {
    std::size_t length = 0;
    if (at > 0) {
      const std::size_t most = std::min(kLongestRun, block.size() - at);
      while (length < most && block[at + length] == block[at - 1]) ++length;
    }
    if (length >= kLeastRun) {
      run(length);
      at += length;
    } else {
      literal(static_cast<unsigned char>(block[at]));
      ++at;
    }
  }
}

void put_block(std::string_view block, bool last, Bits& out) {
  std::vector<std::uint32_t> counts(kLiterals, 0);
  counts[kEnd] = 1;
  visit_parts(
      block, [&](unsigned char byte) { ++counts[byte]; },
      [&](std::size_t length) { ++counts[run_code(length).symbol]; });
  const std::vector<int> lengths = code_lengths(counts, kLongestCode);
  const std::vector<std::uint32_t> codes = codes_of(lengths);
  // The lengths themselves, without repetitions, and that of the one distance, 1.
  std::vector<std::uint32_t> of_lengths(19, 0);
  for (const int length : lengths) ++of_lengths[static_cast<std::size_t>(length)];
  ++of_lengths[1];
  const std::vector<int> short_lengths = code_lengths(of_lengths, kLongestCodeOfLengths);
  const std::vector<std::uint32_t> short_codes = codes_of(short_lengths);
  out.put(last ? 1 : 0, 1);
  out.put(2, 2);
  out.put(kLiterals - 257, 5);
  out.put(0, 5);
  constexpr std::array<std::size_t, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                  11, 4,  12, 3, 13, 2, 14, 1, 15};
  out.put(static_cast<std::uint32_t>(kOrder.size() - 4), 4);
  for (const std::size_t i : kOrder) out.put(static_cast<std::uint32_t>(short_lengths[i]), 3);
  const auto put_length = [&](int length) {
    const auto i = static_cast<std::size_t>(length);
    out.put(short_codes[i], short_lengths[i]);
  };
  for (const int length : lengths) put_length(length);
  put_length(1);
  visit_parts(
      block, [&](unsigned char byte) { out.put(codes[byte], lengths[byte]); },
      [&](std::size_t length) {
        const RunCode run = run_code(length);
        out.put(codes[run.symbol], lengths[run.symbol]);
        out.put(run.bits, run.extra);
        out.put(0, 1);
      });
  out.put(codes[kEnd], lengths[kEnd]);
}

std::uint32_t adler32(std::string_view bytes) {
  constexpr std::uint32_t kPrime = 65521;
  constexpr std::size_t kBeforeOverflow = 5552;
  std::uint32_t a = 1, b = 0;
  for (std::size_t at = 0; at < bytes.size(); at += kBeforeOverflow) {
    for (const char c : bytes.substr(at, kBeforeOverflow)) {
      a += static_cast<unsigned char>(c);
      b += a;
    }
    a %= kPrime;
    b %= kPrime;
  }
  return b << 16 | a;
}

}  // namespace

std::string zlib_bytes(std::string_view bytes) {
  Bits out;
  out.put(0x0178, 16);
  std::size_t at = 0;
  do {
    const std::string_view block = bytes.substr(at, kBlock);
    at += block.size();
    put_block(block, at == bytes.size(), out);
  } while (at < bytes.size());
  std::string made = out.take();
  const std::uint32_t sum = adler32(bytes);
  for (int shift = 24; shift >= 0; shift -= 8) made += static_cast<char>(sum >> shift & 0xFF);
  return made;
}

std::uint32_t crc32(std::string_view bytes) {
  static const auto kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int k = 0; k < 8; ++k) value = value >> 1 ^ (value & 1 ? 0xEDB88320u : 0);
      table[i] = value;
    }
    return table;
  }();
  std::uint32_t sum = 0xFFFFFFFFu;
  for (const char c : bytes) {
    sum = sum >> 8 ^ kTable[(sum ^ static_cast<unsigned char>(c)) & 0xFF];
  }
  return ~sum;
}

}  // namespace beltrami::cli
