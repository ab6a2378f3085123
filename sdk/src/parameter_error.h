// Errors about a parameter: where.pointer is its name behind a slash, a JSON pointer into the call.
#pragma once

#include "etendue/result.h"

#include <string_view>

namespace etendue {

inline Error about(std::string_view parameter, Error error) {
  error.where.pointer = "/" + std::string(parameter);
  return error;
}
inline Error parameter_error(std::string_view parameter, const char* code, std::string text, std::string hint = {}) {
  return about(parameter, {code, std::move(text), {}, std::move(hint), {}});
}

}  // namespace etendue
