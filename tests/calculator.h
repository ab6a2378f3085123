// Evaluates "4*pi/3*(2*sin(inner/2)^2+1)" with given symbols: what a formula of the table says, apart from the code that computes it.
#pragma once

#include <cctype>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace etendue::tests {

class Calculator {
 public:
  Calculator(std::string text, std::map<std::string, double> symbols) : text_(std::move(text)), symbols_(std::move(symbols)) {
    symbols_["pi"] = 3.14159265358979323846;
  }
  // Throws what is wrong with the text.
  double value() {
    const double v = sum();
    if (at_ != text_.size()) throw std::runtime_error("left over: " + text_.substr(at_));
    return v;
  }

 private:
  bool take(char c) {
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!take(c)) throw std::runtime_error(std::string("expected ") + c + " at " + text_.substr(at_));
  }
  double sum() {
    double v = product();
    while (true)
      if (take('+'))
        v += product();
      else if (take('-'))
        v -= product();
      else
        return v;
  }
  double product() {
    double v = power();
    while (true)
      if (take('*'))
        v *= power();
      else if (take('/'))
        v /= power();
      else
        return v;
  }
  double power() {
    const double base = term();
    return take('^') ? std::pow(base, power()) : base;
  }
  double term() {
    if (take('-')) return -term();
    if (take('(')) {
      const double v = sum();
      expect(')');
      return v;
    }
    if (std::isdigit(text_[at_])) {
      std::size_t read = 0;
      const double v = std::stod(text_.substr(at_), &read);
      at_ += read;
      return v;
    }
    std::string name;
    while (at_ < text_.size() && (std::isalnum(text_[at_]) || text_[at_] == '_')) name += text_[at_++];
    if (!take('(')) return symbols_.at(name);
    const double a = sum();
    const double b = take(',') ? sum() : 0;
    expect(')');
    if (name == "sin") return std::sin(a);
    if (name == "cos") return std::cos(a);
    if (name == "atan") return std::atan(a);
    if (name == "atan2") return std::atan2(a, b);
    if (name == "hypot") return std::hypot(a, b);
    if (name == "log2") return std::log2(a);
    throw std::runtime_error("unknown function " + name);
  }

  std::string text_;
  std::size_t at_ = 0;
  std::map<std::string, double> symbols_;
};

}  // namespace etendue::tests
