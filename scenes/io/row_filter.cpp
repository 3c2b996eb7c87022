#include "scenes/io/row_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/particle_columns.h"
#include "scenes/nearest_name.h"

namespace flowskin::scenes {
namespace {

using Rows = std::vector<char>;
constexpr int deepest = 50;
constexpr std::size_t most_shown = 80;

bool is_word_sign(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || (c & 0x80) != 0 ||
         std::string_view("_.:[]").find(c) != std::string_view::npos;
}

/// Recursive descent: one function a level of the grammar.
class Expression {
 public:
  Expression(const std::string& text, const ParticleTable& table, const std::string& name)
      : text_(text), rest_(text), table_(table), name_(name) {}

  Rows evaluate() {
    Rows rows = any_of();
    skip_space(rest_);
    if (!rest_.empty()) fail("expected a comparison, \"and\", \"or\" or the end");
    if (!fault_.empty()) throw InputError(name_ + ", " + fault_);
    return rows;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const std::string where = rest_.empty() ? "at the end" : fmt::format("at \"{}\"", rest_.substr(0, 20));
    throw InputError(fmt::format("--keep '{}': {} {}; an example: 'Type == 1 and z > 0.5'", shown(), what, where));
  }

  /// The expression, as far as a message has room for it.
  std::string shown() const { return text_.size() <= most_shown ? text_ : text_.substr(0, most_shown) + "..."; }

  bool take(std::string_view sign) {
    skip_space(rest_);
    if (!rest_.starts_with(sign)) return false;
    if (is_word_sign(sign.back()) && rest_.size() > sign.size() && is_word_sign(rest_[sign.size()])) return false;
    rest_.remove_prefix(sign.size());
    return true;
  }

  Rows any_of() {
    if (++depth_ > deepest) fail(fmt::format("more than {} levels of brackets or \"not\"", deepest));
    Rows rows = all_of();
    while (take("or") || take("||")) {
      const Rows others = all_of();
      std::transform(rows.begin(), rows.end(), others.begin(), rows.begin(), std::logical_or<>());
    }
    --depth_;
    return rows;
  }

  Rows all_of() {
    Rows rows = one();
    while (take("and") || take("&&")) {
      const Rows others = one();
      std::transform(rows.begin(), rows.end(), others.begin(), rows.begin(), std::logical_and<>());
    }
    return rows;
  }

  Rows one() {
    if (take("not") || take("!")) {
      if (++depth_ > deepest) fail(fmt::format("more than {} levels of brackets or \"not\"", deepest));
      Rows rows = one();
      --depth_;
      std::transform(rows.begin(), rows.end(), rows.begin(), std::logical_not<>());
      return rows;
    }
    if (take("(")) {
      Rows rows = any_of();
      if (!take(")")) fail("expected \")\"");
      return rows;
    }
    return comparisons();
  }

  /// A column of the table or a number.
  struct Operand {
    const std::vector<double>* column = nullptr;
    double number = 0;
    double at(std::size_t row) const { return column != nullptr ? (*column)[row] : number; }
  };

  /// a < b, or a < b < c and so on, which holds where each two neighbours are as they should.
  Rows comparisons() {
    const std::string_view start = rest_;
    Rows rows(table_.count, 1);
    Operand left = take_operand();
    bool has_column = left.column != nullptr, is_first = true;
    for (auto compare = take_comparison(); compare; compare = take_comparison()) {
      const Operand right = take_operand();
      has_column = has_column || right.column != nullptr;
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = rows[i] && compare(left.at(i), right.at(i));
      left = right;
      is_first = false;
    }
    if (is_first) fail("expected a comparison such as == or <");
    if (!has_column) {
      rest_ = start;
      fail("expected the name of a column on one side");
    }
    return rows;
  }

  Operand take_operand() {
    skip_space(rest_);
    double number = 0;
    std::string_view after = rest_;
    const bool is_number = take_number(after, number) && (after.empty() || !is_word_sign(after.front()));
    if (!is_number) return {&take_column(), 0};
    if (std::isnan(number)) fail("nan compares with nothing");
    rest_ = after;
    return {nullptr, number};
  }

  /// Nothing where none follows.
  std::function<bool(double, double)> take_comparison() {
    if (take("==")) return std::equal_to<>();
    if (take("!=")) return std::not_equal_to<>();
    if (take("<=")) return std::less_equal<>();
    if (take(">=")) return std::greater_equal<>();
    if (take("<")) return std::less<>();
    if (take(">")) return std::greater<>();
    if (take("=")) return std::equal_to<>();
    return {};
  }

  const std::vector<double>& take_column() {
    skip_space(rest_);
    std::string word;
    const char quote = rest_.empty() ? '\0' : rest_.front();
    if (quote == '"' || quote == '\'') {
      const std::size_t end = rest_.find(quote, 1);
      if (end == std::string_view::npos) fail("expected the closing quote of a column's name");
      word = rest_.substr(1, end - 1);
      rest_.remove_prefix(end + 1);
    } else {
      const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_word_sign);
      word = std::string(rest_.begin(), end);
      rest_.remove_prefix(word.size());
    }
    if (word.empty()) fail("expected the name of a column or a number");
    return column_called(word);
  }

  const std::vector<double>& column_called(const std::string& word) {
    auto found = table_.columns.find(word);
    if (found == table_.columns.end())
      found = std::find_if(table_.columns.begin(), table_.columns.end(), [&](const auto& column) {
        return plain_column_name(column.first) == plain_column_name(word);
      });
    if (found == table_.columns.end()) {
      std::vector<std::string> names;
      for (const auto& column : table_.columns) names.push_back(column.first);
      throw InputError(fmt::format("{}: --keep '{}': there is no column \"{}\"{}", name_, shown(),
                                   word.substr(0, most_shown), did_you_mean(word, names)));
    }
    if (const auto fault = table_.faults.find(found->first); fault != table_.faults.end() && fault_.empty())
      fault_ = fault->second;
    return found->second;
  }

  const std::string& text_;
  std::string_view rest_;
  const ParticleTable& table_;
  const std::string& name_;
  std::string fault_;  // of the first column at fault: what is wrong with the expression is told before
  int depth_ = 0;
};

template <class T>
void keep_rows(std::vector<T>& values, const Rows& wanted) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (wanted[i]) values[kept++] = values[i];
  values.resize(kept);
}

}  // namespace

Rows rows_that(const std::string& expression, const ParticleTable& table, const std::string& name) {
  return Expression(expression, table, name).evaluate();
}

ParticleTable rows_of(const ParticleTable& table, const Rows& wanted) {
  ParticleTable rows = table;
  for (auto& [name, values] : rows.columns) keep_rows(values, wanted);
  for (auto& [name, values] : rows.ids) keep_rows(values, wanted);
  rows.count = static_cast<std::size_t>(std::count_if(wanted.begin(), wanted.end(), [](char c) { return c != 0; }));
  return rows;
}

}  // namespace flowskin::scenes
