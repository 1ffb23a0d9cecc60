// What scenes are drawn from at random.
#pragma once

#include <initializer_list>
#include <random>
#include <string>

namespace topple::app {

class RandomDraw {
 public:
  explicit RandomDraw(unsigned seed) : random_(seed) {}

 protected:
  bool chance(double share) { return uniform(0, 1) < share; }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  int pick(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  std::string one_of(std::initializer_list<const char*> words) {
    return *(words.begin() + pick(0, static_cast<int>(words.size()) - 1));
  }

 private:
  std::mt19937 random_;
};

}  // namespace topple::app
