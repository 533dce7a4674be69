"""Finds structs of more than four fields that are filled by position: who reads `{1, 0.5, 3, true, 2}` has to count fields, and a field that is
added in the middle moves the others. A default one is made and its fields are assigned, or a function with a name makes it.

Reads the C++ files of all top folders. It is no compiler. It knows the fields of each plain struct (one without constructors and private
parts), and of a list in braces what its place tells: a name before it, the function that returns it or is called with it, the variable,
member or vector that takes it. Of names that mean several types it takes the one nearest: the file's own, then the folders above.
Arrays, matrices and tables (constants, or several rows below one another) are no faults, nor is a list of one value: it says what the
struct is of. References cannot be assigned: a list may hold those that a struct begins with.

Prints one line per fault; status 1 where there is any. Usage: named_fields.py REPOSITORY
"""

import collections
import itertools
import re

import rule_command

TOP = ("pipeline", "drivers", "detector", "pose", "tools", "tests")
MOST = 4
# Intrinsic matrices with the size of their images, in the order of every calibration file and of --camera WIDTHxHEIGHT,fx,fy,cx,cy.
MATRICES = {"Camera", "rs2_intrinsics"}
NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*', re.DOTALL | re.MULTILINE)
STRUCT = re.compile(r"\bstruct\s+([\w:]+)(?:\s+final)?\s*(?::\s*((?:public\s+)?[\w:]+)\s*)?\{")
OPENING, CLOSING = "([{", ")]}"
# A type's name as the last but one word before a variable's; after these words no variable is declared.
NO_TYPE = {"return", "else", "new", "delete", "using", "namespace", "typename", "class", "struct", "enum", "goto", "case", "throw", "co_return"}
VARIABLE = re.compile(r"(?<![\w.>:])((?:const\s+)?[A-Za-z_][\w:]*(?:<[^;{}()=]*>)?)[\s&*]+(\w+)\s*(?=[;={(,)\[:])")
FUNCTION = re.compile(r"((?:[\w:]+(?:<[^;{}()]*>)?))[\s&*]+([A-Za-z_][\w:]*)\s*\(")


def code_of(text):
    """The text without comments, strings and preprocessor lines, which become blanks so that places stay the same."""
    blank = lambda found: re.sub(r"[^\n]", " ", found.group()) if not found.group().startswith(('"', "R", "'")) else \
        "0" + re.sub(r"[^\n]", " ", found.group()[1:])
    return NOT_CODE.sub(blank, text)


def closing_of(code, begin):
    """Returns the place where the bracket that opens at `begin` closes."""
    depth = 0
    for place in range(begin, len(code)):
        if code[place] in OPENING:
            depth += 1
        elif code[place] in CLOSING:
            depth -= 1
            if depth == 0:
                return place
    return len(code)


def template_angles(code):
    """The places of angle brackets between which nothing but types stands."""
    found, open_ones = set(), []
    for place, letter in enumerate(code):
        if letter == "<":
            open_ones.append(place)
        elif letter == ">" and open_ones and code[place - 1] != "-":
            found.update((open_ones.pop(), place))
        elif not re.match(r"[\w:\s,*&()]", letter):
            open_ones.clear()
    return found


def parts_of(code):
    """Returns what stands between the commas of a list; commas in brackets, and in template arguments that hold nothing else,
    do not count."""
    parts, depth, part = [], 0, ""
    angles = template_angles(code)
    for place, letter in enumerate(code):
        depth += (letter in OPENING or (letter == "<" and place in angles)) - (letter in CLOSING or (letter == ">" and place in angles))
        if letter == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += letter
    parts.append(part)
    return [part.strip() for part in parts if part.strip()]


def last_name(name):
    return re.sub(r"\s", "", name).split("::")[-1]


def statements_of(body):
    """The statements of a struct's body, without the bodies of its functions and of the types in it."""
    out, part, place = [], "", 0
    while place < len(body):
        letter = body[place]
        if letter == "{":
            end = closing_of(body, place)
            head = part.strip()
            if re.search(r"\)\s*(const|noexcept|override|final|\s|->[\w:<>&*\s]+)*$", head) or re.match(
                    r"(template\s*<.*>\s*)?(struct|class|enum|union)\b", head, re.DOTALL):
                out.append(head + " {}")
                part = ""
                after = re.match(r"\s*;", body[end + 1:])
                place = end + 1 + (after.end() if after else 0)
                continue
            part += "{}"
            place = end + 1
            continue
        if letter == ";":
            out.append(part.strip())
            part = ""
        else:
            part += letter
        place += 1
    return out


def fields_of(name, body):
    """[(type, name)] of a plain struct's own fields in their order; None where it is none that braces fill."""
    fields = []
    for statement in statements_of(body):
        statement = re.sub(r"^(?:public\s*:\s*)+", "", statement)
        if not statement or re.match(r"(using|static|friend|template|typedef|constexpr|inline|enum|struct|class|union)\b", statement):
            continue
        if re.match(r"(private|protected)\s*:", statement) or re.match(r"virtual\b", statement):
            return None
        if re.match(r"(explicit\s+)?~?%s\s*\(" % re.escape(last_name(name)), statement):
            return None
        if statement.endswith(" {}") and "(" in statement or re.search(r"\)\s*(const|noexcept|= default|= delete|\s)*$", statement.split("=")[0]) \
                and not re.search(r"\bstd\s*::\s*function\b", statement) and "(*" not in statement:
            continue
        # `int a = 1, b = 2` is two fields.
        declared = parts_of(statement)
        first = re.match(r"(.*?)([A-Za-z_]\w*)\s*(\[[^]]*\])?\s*(=.*|\{\})?$", declared[0], re.DOTALL)
        if not first:
            continue
        fields.append((first.group(1).strip(), first.group(2)))
        for more in declared[1:]:
            fields.append((first.group(1).strip(), re.match(r"[*&\s]*(\w+)", more).group(1) if re.match(r"[*&\s]*(\w+)", more) else "?"))
    return fields


def plain(type_name):
    """A type without what does not change its fields."""
    return re.sub(r"\b(?:const|static|inline|mutable|constexpr|typename)\b|[&*]|\s", "", type_name)


def element_of(type_name):
    """Returns the type that a vector or the like holds, as nested lists fill it; None where it is no container."""
    found = re.match(r"(?:std::)?(?:vector|deque|list|array|optional|initializer_list|set)<(.*)>$", type_name)
    return parts_of(found.group(1))[0] if found else None


def leading_references(fields):
    return sum(1 for _ in itertools.takewhile(lambda field: "&" in field[0], fields))


class Types:
    """The types of the repository's sources: fields of structs, variables, members, results and parameters of functions."""

    def __init__(self, codes):
        self.structs = collections.defaultdict(list)  # name: [(file, fields or None)]
        self.members = collections.defaultdict(set)  # name: types
        self.results = collections.defaultdict(set)
        self.parameters = collections.defaultdict(set)
        for file, code in codes.items():
            for found in STRUCT.finditer(code):
                begin = found.end() - 1
                fields = fields_of(found.group(1), code[begin + 1:closing_of(code, begin)])
                if fields is not None and found.group(2):
                    fields = [("?", "?")] * len(self.fields(found.group(2), file) or ()) + fields
                self.structs[last_name(found.group(1))].append((file, fields))
                for type_name, name in fields or ():
                    self.members[name].add(plain(type_name))
            for found in re.finditer(r"\busing\s+(\w+)\s*=|\bclass\s+(\w+)[^;{(]*\{", code):
                self.structs[found.group(1) or found.group(2)].append((file, None))
            for found in FUNCTION.finditer(code):
                end = closing_of(code, found.end() - 1)
                if not re.match(r"\s*(?:const\b|noexcept\b|override\b|\s)*[;{:]", code[end + 1:end + 40]):
                    continue
                name = last_name(found.group(2))
                self.results[name].add(plain(found.group(1)))
                declared = (re.match(r"(.*?[\s&*>])\w+\s*(?:=.*)?$", part, re.DOTALL) for part in parts_of(code[found.end():end]))
                self.parameters[name].add(tuple(plain(one.group(1)) if one else "?" for one in declared))

    def fields(self, name, file):
        """Returns the fields of the definition nearest to `file`; None where it is no plain struct of ours."""
        unit = file.rsplit(".", 1)[0]

        def distance(entry):
            other = entry[0].rsplit(".", 1)[0]
            same = sum(1 for _ in itertools.takewhile(lambda two: two[0] == two[1], zip(unit.split("/"), other.split("/"))))
            # What a source defines is its own.
            return (other != unit, entry[0].endswith(".cpp"), -same)

        found = min(self.structs.get(last_name(name), ()), key=distance, default=None)
        return found[1] if found and not (found[0].endswith(".cpp") and found[0] != file) else None


def only(types):
    """The one type that all agree on; None where they do not."""
    return next(iter(types)) if len(types) == 1 else None


class Source:
    """A source whose lists in braces are looked at."""

    def __init__(self, file, code, types):
        self.file, self.code, self.types = file, code, types
        self.variables = collections.defaultdict(list)  # name: [(place, type)]
        for found in VARIABLE.finditer(code):
            if last_name(found.group(1)) not in NO_TYPE:
                self.variables[found.group(2)].append((found.start(), plain(found.group(1))))
        self.lists = {}  # of each brace: the type of the list that begins there, or None

    def type_of_name(self, name, place):
        """Returns the type of a name: of `a` the variable declared last before `place`, else the member that is called so; of
        `a.b` the member b of the type of a."""
        *owner, last = re.split(r"\.|->", name)
        if owner:
            fields = self.types.fields(self.type_of_name(".".join(owner), place) or "", self.file)
            of_owner = [plain(type_name) for type_name, field in fields or () if field == last]
            return of_owner[0] if of_owner else only(self.types.members.get(last, set()))
        before = [type_name for begin, type_name in self.variables.get(last, ()) if begin < place]
        return before[-1] if before else only(self.types.members.get(last, set()))

    def result_at(self, place):
        """Returns the result type of the function whose body `place` is in."""
        depth = 0
        for begin in range(place - 1, -1, -1):
            depth += (self.code[begin] == "}") - (self.code[begin] == "{")
            if depth < 0:
                head = re.search(r"(?:^|[;{}])\s*([^;{}]*)$", self.code[:begin]).group(1)
                if re.search(r"\]\s*(?:\([^()]*(?:\([^()]*\)[^()]*)*\))?\s*(?:mutable\s*)?(?:->\s*([\w:<>]+)\s*)?$", head):
                    written = re.search(r"->\s*([\w:<>]+)\s*$", head)
                    return plain(written.group(1)) if written else None
                found = FUNCTION.search(head + " ")
                if found and not re.match(r"(?:if|for|while|switch|catch)\b", last_name(found.group(2))):
                    return plain(found.group(1))
                depth = 0
        return None

    def type_before(self, begin):
        """Returns the type of the list that opens at `begin`, by what stands before it."""
        head = self.code[max(0, begin - 300):begin].rstrip()
        if head.endswith(("return", "co_return")):
            return self.result_at(begin)
        declared = re.search(r"([\w:]+(?:<[^;{}()]*>)?)[\s&*]+(\w+)\s*=?$", head)
        if declared and last_name(declared.group(1)) not in NO_TYPE and not re.search(r"\b(?:struct|class|enum|namespace)\s+[\w:]+\s*$", head):
            if not declared.group(1)[0].isdigit():
                return "" if re.search(r"constexpr[^;{}]*$", head) else plain(declared.group(1))
        named = re.search(r"([\w:]+(?:<[^;{}()]*>)?)$", head)
        if named and not re.search(r"\b(?:struct|class|enum|namespace|else|do|try)\s*[\w:]*$", head):
            return plain(named.group(1))
        assigned = re.search(r"((?:\w+(?:\.|->))*\w+)\s*=$", head)
        if assigned:
            return self.type_of_name(assigned.group(1), begin)
        return None

    def type_as_argument(self, begin):
        """Returns the type of the list that opens at `begin` among the arguments of a call."""
        opening = self.enclosing(begin)
        if opening is None or self.code[opening] != "(":
            return None
        index = len(parts_of(self.code[opening + 1:begin] + "0")) - 1
        head = self.code[max(0, opening - 200):opening].rstrip()
        added = re.search(r"((?:\w+(?:\.|->))*\w+)\s*(?:\.|->)\s*(?:push_back|emplace_back|insert|push_front|assign|emplace)$", head)
        if added:
            return element_of(self.type_of_name(added.group(1), begin) or "")
        called = re.search(r"([\w:]+)$", head)
        if not called:
            return None
        fitting = {one[index] for one in self.types.parameters.get(last_name(called.group(1)), ()) if index < len(one)}
        return only(fitting)

    def enclosing(self, place):
        """Returns the place where the bracket opens that `place` is in."""
        depth = 0
        for begin in range(place - 1, -1, -1):
            if self.code[begin] in CLOSING:
                depth += 1
            elif self.code[begin] in OPENING:
                if depth == 0:
                    return begin
                depth -= 1
        return None

    def type_of_list(self, begin):
        before = self.code[:begin].rstrip()[-1:]
        if before not in "{,(":
            return self.type_before(begin)
        opening = self.enclosing(begin)
        if opening is not None and self.code[opening] == "{":
            outer = self.lists.get(opening)
            if not outer:
                return None
            element = element_of(outer)
            if element:
                return element
            fields = self.types.fields(outer, self.file) or ()
            index = len(parts_of(self.code[opening + 1:begin] + "0")) - 1
            return plain(fields[index][0]) if index < len(fields) else None
        return self.type_as_argument(begin)

    def is_row(self, begin, outer):
        """Returns whether a list is one of several below one another in a list of them: a table."""
        opening = self.enclosing(begin)
        return bool(outer and element_of(outer)) and len(parts_of(self.code[opening + 1:closing_of(self.code, opening)])) > 1

    def faults(self):
        for found in re.finditer(r"\{", self.code):
            begin = found.start()
            kind = self.lists[begin] = self.type_of_list(begin)
            inner = self.code[begin + 1:closing_of(self.code, begin)]
            if not kind or not inner.strip() or ";" in re.sub(r"\{[^{}]*\}", "", inner):
                continue
            fields = self.types.fields(re.sub(r"<.*", "", kind), self.file)
            values = len(parts_of(inner))
            is_filled = fields and len(fields) > MOST and values > max(1, leading_references(fields)) and last_name(kind) not in MATRICES
            if is_filled and not self.is_row(begin, outer=self.lists.get(self.enclosing(begin))):
                yield f"{self.file}:{self.code.count(chr(10), 0, begin) + 1}: {kind} has {len(fields)} fields, and is filled by their places"


def read_codes(root):
    return {
        file.relative_to(root).as_posix(): code_of(file.read_text())
        for top in TOP for file in sorted((root / top).rglob("*")) if file.suffix in {".cpp", ".hpp"}
    }


def find_faults(root):
    codes = read_codes(root)
    types = Types(codes)
    return [fault for file, code in codes.items() for fault in Source(file, code, types).faults()]


if __name__ == "__main__":
    rule_command.run(find_faults, "no struct of many fields is filled by their places")
