// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/random.hpp"

#include <Random123/philox.h>

#include <cmath>

namespace sim {

namespace {

/// Finalizer of SplitMix64: keys of neighboring seeds are unrelated.
std::uint64_t mixed(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15ULL;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

std::uint32_t low_word(std::uint64_t word) {
  return static_cast<std::uint32_t>(word);
}
std::uint32_t high_word(std::uint64_t word) {
  return static_cast<std::uint32_t>(word >> 32);
}

/// Evaluates c[0] + c[1] x + c[2] x^2 + ... in nested form.
template <std::size_t N>
double polynomial(const double (&c)[N], double x) {
  double sum = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + c[i];
  return sum;
}

}  // namespace

std::uint64_t hash_text(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

Random::Random(std::uint64_t seed, std::string_view name) {
  const std::uint64_t key = mixed(mixed(seed) ^ hash_text(name));
  key_[0] = low_word(key);
  key_[1] = high_word(key);
  begin_step(-1);  // draws during construction differ from those of any step
}

void Random::begin_step(std::int64_t step) {
  const auto word = static_cast<std::uint64_t>(step);
  counter_[0] = low_word(word);
  counter_[1] = high_word(word);
  counter_[2] = 0;
  counter_[3] = 0;
  block_[0] = block_[1] = 0;
  used_ = 2;
}

void Random::refill() {
  const r123::Philox4x32_R<10>::ctr_type counter = {{counter_[0], counter_[1], counter_[2], counter_[3]}};
  const r123::Philox4x32_R<10>::key_type key = {{key_[0], key_[1]}};
  const auto words = r123::Philox4x32_R<10>()(counter, key);
  block_[0] = words[0] | static_cast<std::uint64_t>(words[1]) << 32;
  block_[1] = words[2] | static_cast<std::uint64_t>(words[3]) << 32;
  used_ = 0;
  if (++counter_[2] == 0) ++counter_[3];
}

std::uint64_t Random::bits() {
  if (used_ == 2) refill();
  return block_[used_++];
}

double Random::uniform() {
  // Midpoints of 2^52 equal intervals: with 53 bits the last midpoint would round to 1.
  return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52;
}

double Random::gaussian() {
  return normal_quantile(uniform());
}

std::uint32_t Random::integer_below(std::uint32_t n) {
  // Lemire 2019, "Fast random integer generation in an interval": the high word of a product; rejection of the low
  // words that would be over-represented removes the bias.
  const std::uint32_t refused_below = (0u - n) % n;
  std::uint64_t product;
  do {
    product = static_cast<std::uint64_t>(high_word(bits())) * n;
  } while (low_word(product) < refused_below);
  return high_word(product);
}

double normal_quantile(double p) {
  // Wichura 1988, "Algorithm AS 241: The percentage points of the normal distribution", function PPND16.
  static constexpr double a[] = {3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                                 1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                                 3.3430575583588128105e+4, 2.5090809287301226727e+3};
  static constexpr double b[] = {1.0,
                                 4.2313330701600911252e+1,
                                 6.8718700749205790830e+2,
                                 5.3941960214247511077e+3,
                                 2.1213794301586595867e+4,
                                 3.9307895800092710610e+4,
                                 2.8729085735721942674e+4,
                                 5.2264952788528545610e+3};
  static constexpr double c[] = {1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                                 3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                                 2.27238449892691845833e-2, 7.74545014278341407640e-4};
  static constexpr double d[] = {1.0,
                                 2.05319162663775882187e0,
                                 1.67638483018380384940e0,
                                 6.89767334985100004550e-1,
                                 1.48103976427480074590e-1,
                                 1.51986665636164571966e-2,
                                 5.47593808499534494600e-4,
                                 1.05075007164441684324e-9};
  static constexpr double e[] = {6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                                 2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                 2.71155556874348757815e-5, 2.01033439929228813265e-7};
  static constexpr double f[] = {1.0,
                                 5.99832206555887937690e-1,
                                 1.36929880922735805310e-1,
                                 1.48753612908506148525e-2,
                                 7.86869131145613259100e-4,
                                 1.84631831751005468180e-5,
                                 1.42151175831644588870e-7,
                                 2.04426310338993978564e-15};
  // Central region.
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(a, r) / polynomial(b, r);
  }
  // Tails.
  const double r = std::sqrt(-std::log(q < 0 ? p : 1 - p));
  const double magnitude =
      r <= 5 ? polynomial(c, r - 1.6) / polynomial(d, r - 1.6) : polynomial(e, r - 5) / polynomial(f, r - 5);
  return q < 0 ? -magnitude : magnitude;
}

}  // namespace sim
