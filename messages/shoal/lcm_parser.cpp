// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/lcm_parser.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace shoal {
namespace {

constexpr int max_length_slots = 64;  // the validator keeps the lengths of a type on the stack
constexpr std::int64_t max_constant_size = 1 << 24;

struct Token {
  std::string text;  // empty at the end of the file
  int line = 1;
  int column = 1;
};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

std::string trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '/')) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return std::string(text);
}

struct Primitive {
  std::string_view name;
  WireType type;
};
constexpr std::array primitives{
    Primitive{"boolean", WireType::boolean}, Primitive{"byte", WireType::byte},
    Primitive{"int8_t", WireType::int8},     Primitive{"int16_t", WireType::int16},
    Primitive{"int32_t", WireType::int32},   Primitive{"int64_t", WireType::int64},
    Primitive{"float", WireType::float32},   Primitive{"double", WireType::float64},
    Primitive{"string", WireType::string},
};

bool is_integer(WireType type) {
  return type == WireType::int8 || type == WireType::int16 || type == WireType::int32 || type == WireType::int64;
}

class Parser {
 public:
  explicit Parser(const LcmSource& source) : file_(source.file), text_(source.text) { advance(); }

  std::vector<MessageSchema> parse() {
    std::vector<MessageSchema> types;
    while (!token_.text.empty()) {
      if (token_.text == "package") {
        advance();
        package_ = word("a package name");
        expect(";");
      } else if (token_.text == "struct") {
        types.push_back(parse_struct());
      } else if (token_.text == "enum") {
        types.push_back(parse_enum());
      } else {
        fail("expected 'package', 'struct' or 'enum', got '" + token_.text + "'");
      }
    }
    return types;
  }

 private:
  using Constants = std::map<std::string, std::int64_t>;

  [[noreturn]] void fail(const std::string& what) const {
    throw MessageError(file_ + ":" + std::to_string(token_.line) + ":" + std::to_string(token_.column) + ": " + what);
  }

  void advance() {
    skip_blanks_and_comments();
    token_ = Token{"", line_, column_};
    if (at_ >= text_.size()) return;
    const std::size_t start = at_;
    // Numbers are words, too, with their signs and exponents.
    if (is_word(text_[at_]) || text_[at_] == '-' || text_[at_] == '+') {
      do step();
      while (at_ < text_.size() && (is_word(text_[at_]) || is_exponent_sign()));
    } else {
      step();
    }
    token_.text = std::string(text_.substr(start, at_ - start));
  }

  bool is_exponent_sign() const {
    return (text_[at_] == '-' || text_[at_] == '+') && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E');
  }

  void step() {
    if (text_[at_] == '\n') {
      ++line_;
      column_ = 1;
    } else {
      ++column_;
    }
    ++at_;
  }

  void skip_blanks_and_comments() {
    while (at_ < text_.size()) {
      if (std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
        step();
      } else if (text_.substr(at_, 2) == "//") {
        const std::size_t start = at_;
        const int line = line_;
        while (at_ < text_.size() && text_[at_] != '\n') step();
        // The comment above a declaration becomes its description in the documentation.
        comments_[line] = trimmed(text_.substr(start, at_ - start));
      } else if (text_.substr(at_, 2) == "/*") {
        while (at_ < text_.size() && text_.substr(at_, 2) != "*/") step();
        if (at_ >= text_.size()) fail("comment without end");
        step();
        step();
      } else {
        return;
      }
    }
  }

  void expect(const std::string& text) {
    if (token_.text != text) fail("expected '" + text + "', got '" + token_.text + "'");
    advance();
  }

  std::string word(const std::string& what) {
    if (token_.text.empty() || !is_word(token_.text[0]) || std::isdigit(static_cast<unsigned char>(token_.text[0])))
      fail("expected " + what + ", got '" + token_.text + "'");
    std::string text = token_.text;
    advance();
    return text;
  }

  std::optional<std::int64_t> integer(std::string_view text) const {
    int base = 10;
    if (text.substr(0, 2) == "0x" || text.substr(0, 2) == "0X") {
      base = 16;
      text.remove_prefix(2);
    }
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  /// Returns the comment lines directly above `line`.
  std::string comment_above(int line) const {
    std::string text;
    for (auto it = comments_.find(--line); it != comments_.end(); it = comments_.find(--line))
      text = text.empty() ? it->second : it->second + " " + text;
    return text;
  }

  std::string qualified(const std::string& name) const {
    return package_.empty() || name.find('.') != std::string::npos ? name : package_ + "." + name;
  }

  MessageSchema parse_struct() {
    MessageSchema schema;
    schema.comment = comment_above(token_.line);
    advance();
    schema.name = qualified(word("a type name"));
    expect("{");
    Constants constants;
    while (token_.text != "}") {
      if (token_.text == "const") {
        parse_constants(constants);
      } else {
        parse_members(schema, constants);
      }
    }
    advance();
    if (token_.text == ";") advance();
    return schema;
  }

  MessageSchema parse_enum() {
    MessageSchema schema;
    schema.comment = comment_above(token_.line);
    schema.is_enum = true;
    advance();
    schema.name = qualified(word("a type name"));
    expect("{");
    while (token_.text != "}") {
      if (token_.text.empty()) fail("enum without end");
      advance();
    }
    advance();
    if (token_.text == ";") advance();
    // On the wire an enum of LCM is a struct with one int32.
    Member value;
    value.name = "value";
    value.type_name = "int32_t";
    value.type = WireType::int32;
    schema.members.push_back(value);
    return schema;
  }

  void parse_constants(Constants& constants) {
    advance();
    word("the type of the constant");
    while (true) {
      const std::string name = word("the name of the constant");
      expect("=");
      // Only whole numbers can be sizes of arrays; others are read over.
      if (const auto value = integer(token_.text)) constants[name] = *value;
      if (token_.text.empty() || token_.text == ";" || token_.text == "}") fail("expected a value");
      advance();
      if (token_.text != ",") break;
      advance();
    }
    expect(";");
  }

  void parse_members(MessageSchema& schema, const Constants& constants) {
    const int line = token_.line;
    Member declared;
    declared.type_name = word("a member or '}'");
    const auto primitive = std::find_if(primitives.begin(), primitives.end(),
                                        [&](const Primitive& p) { return p.name == declared.type_name; });
    declared.type = primitive != primitives.end() ? primitive->type : WireType::compound;
    if (declared.type == WireType::compound) declared.type_name = qualified(declared.type_name);
    const std::size_t first = schema.members.size();
    while (true) {
      Member member = declared;
      const Token at = token_;
      member.name = word("the name of the member");
      for (const Member& other : schema.members)
        if (other.name == member.name) {
          token_ = at;
          fail("duplicate member '" + member.name + "'");
        }
      while (token_.text == "[") {
        advance();
        member.dimensions.push_back(parse_dimension(schema, constants));
        expect("]");
      }
      schema.members.push_back(std::move(member));
      if (token_.text != ",") break;
      advance();
    }
    expect(";");
    // The comment after the semicolon was read with the next token.
    if (const auto it = comments_.find(line); it != comments_.end())
      for (std::size_t i = first; i < schema.members.size(); ++i) schema.members[i].comment = it->second;
  }

  Dimension parse_dimension(MessageSchema& schema, const Constants& constants) {
    Dimension dimension;
    dimension.text = token_.text;
    // Constant size: a number, or the name of a constant.
    std::optional<std::int64_t> size = integer(token_.text);
    if (const auto it = constants.find(token_.text); it != constants.end()) size = it->second;
    if (size) {
      if (*size <= 0 || *size > max_constant_size)
        fail("array size must be between 1 and 16777216, got " + token_.text);
      dimension.constant = *size;
      advance();
      return dimension;
    }
    // Variable size: an integer member declared before.
    const auto length = std::find_if(schema.members.begin(), schema.members.end(),
                                     [&](const Member& m) { return m.name == token_.text; });
    if (length == schema.members.end()) fail("array size '" + token_.text + "' is not a member declared before");
    if (!is_integer(length->type) || !length->dimensions.empty())
      fail("array size '" + token_.text + "' must be a plain integer member");
    if (length->length_slot < 0) {
      if (schema.length_slots == max_length_slots) fail("more than 64 members give array sizes");
      length->length_slot = schema.length_slots++;
    }
    dimension.length_slot = length->length_slot;
    advance();
    return dimension;
  }

  std::string file_;
  std::string_view text_;
  std::string package_;
  std::map<int, std::string> comments_;  // by line
  std::size_t at_ = 0;
  int line_ = 1;
  int column_ = 1;
  Token token_;
};

}  // namespace

std::vector<MessageSchema> parse_lcm(const LcmSource& source) {
  return Parser(source).parse();
}

}  // namespace shoal
