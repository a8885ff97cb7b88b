// How the C++ header is compiled: with exceptions or without, and in a namespace for either.
#ifndef BELTRAMI_CPP_CONFIG_HPP
#define BELTRAMI_CPP_CONFIG_HPP

#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define BELTRAMI_CPP_EXCEPTIONS 1
#define BELTRAMI_CPP_NAMESPACE cpp
#else
// Without exceptions the functions that throw are not declared, those named try_ are.
#define BELTRAMI_CPP_EXCEPTIONS 0
#define BELTRAMI_CPP_NAMESPACE cpp_without_exceptions
#endif

// The inner namespace keeps inline functions apart in a program that compiles some sources with
// exceptions and some without, and apart from what a static library has in namespace beltrami.
#define BELTRAMI_CPP_BEGIN \
  namespace beltrami {     \
  inline namespace BELTRAMI_CPP_NAMESPACE {
#define BELTRAMI_CPP_END \
  }                      \
  }

#endif  // BELTRAMI_CPP_CONFIG_HPP
