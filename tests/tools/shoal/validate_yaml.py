#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds YAML files against the JSON Schemas of docs/reference/schema/, by python3-jsonschema: a second opinion on
what the loader accepts.

usage: validate_yaml.py SCHEMA_DIR accept FILE...     every file must validate, and name its schema in a comment
       validate_yaml.py SCHEMA_DIR refuse FOLDER      bad worlds whose mistake a schema can say must not
"""
import json
import pathlib
import re
import sys

import jsonschema
import yaml

# What a schema can say, as the first line of a file in tests/bad_worlds/ words it.
EXPRESSIBLE = [
    r"unknown key", r"unknown device type", r"missing key", r"must be one of:", r"must be (>|<|1,)",
    r"must be a number", r"must be a whole number, ", r"must be a map", r"must be a list", r"must be true or false",
    r"must be finite", r"a name must be made of", r"unknown action", r"an action has one key",
    r"a new object stands in",
]
# Files whose message fits although no schema of the world file can find the mistake.
SKIPPED = {
    "acoustic_modem_wider_than_its_frequency": "a rule between two keys",
    "vibration_of_no_band": "a rule between two keys",
    "mistake_in_an_included_file": "the mistake is in the included file",
    "vehicle_file_with_a_mistake": "the mistake is in the vehicle file",
    "vehicle_file_without_version": "the mistake is in the vehicle file",
    "override_of_unknown_key": "overrides are paths, and change a file the schema does not see",
    "change_to_a_bad_value": "the values of a `set` action belong to a device elsewhere",
    "condition_of_no_speed": "`when` is its own sentence grammar",
    "condition_of_unknown_form": "`when` is its own sentence grammar",
    "beam_samples_without_divergence": "one key needs another",
    "rings_upside_down": "one number depends on another",
    "added_mass_of_the_wrong_sign": "numbers of one list have rules of their own",
    "damping_that_drives": "numbers of one list have rules of their own",
    "derivative_that_drives": "the names of derivatives are their own grammar",
    "dvl_layer_that_ends_before_it_begins": "one number depends on another",
    "radar_blind_to_its_range": "one number depends on another",
    "turn_of_an_hour": "the bound depends on the type of the device",
    "sonar_picture_too_large": "the product of two numbers is limited",
    "metric_with_a_key_of_another_type": "the keys depend on another key",
    "metric_without_its_channel": "one key needs another",
    "metric_of_no_vehicle": "names are not in the schema",
    "acoustics_link_of_nobody": "names are not in the schema",
}


class CoreLoader(yaml.SafeLoader):
    """YAML 1.2 core schema, as Shoal and editors read it: 1e-3 is a number, `yes` and dates are text."""

    yaml_implicit_resolvers = {}

    def construct_mapping(self, node, deep=False):
        keys = [key.value for key, _ in node.value]
        if len(set(keys)) != len(keys):
            raise yaml.constructor.ConstructorError(None, None, "duplicate key", node.start_mark)
        return {key.value: self.construct_object(value, deep=True) for key, value in node.value}


def construct_float(_, node):
    text = node.value.lower().lstrip("+")
    return float(text.replace(".inf", "inf").replace(".nan", "nan"))


CoreLoader.add_implicit_resolver("tag:yaml.org,2002:null", re.compile(r"^(~|null|Null|NULL|)$"), None)
CoreLoader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(true|True|TRUE|false|False|FALSE)$"), None)
CoreLoader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?[0-9]+$"), None)
CoreLoader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^([-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN))$"), None)
CoreLoader.add_constructor("tag:yaml.org,2002:int", lambda _, node: int(node.value, 10))
CoreLoader.add_constructor("tag:yaml.org,2002:float", construct_float)


def is_finite_number(checker, instance):
    """JSON has no infinity, so a schema's "number" is a finite one."""
    is_number = jsonschema.Draft7Validator.TYPE_CHECKER.is_type(instance, "number")
    return is_number and instance == instance and instance not in (float("inf"), float("-inf"))


Validator = jsonschema.validators.extend(
    jsonschema.Draft7Validator,
    type_checker=jsonschema.Draft7Validator.TYPE_CHECKER.redefine("number", is_finite_number))


def validator_of(schema_dir, kind):
    schema = json.loads((schema_dir / f"{kind}.schema.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    return Validator(schema)


def mistakes(validator, path):
    """One line for each error."""
    document = yaml.load(path.read_text(), Loader=CoreLoader)
    for error in validator.iter_errors(document):
        error = jsonschema.exceptions.best_match([error])
        yield f"{path}: /{'/'.join(str(part) for part in error.absolute_path)}: {error.message[:200]}"


def accept(schema_dir, files):
    found = []
    for path in files:
        first = path.read_text().split("\n", 1)[0]
        named = re.fullmatch(r"# yaml-language-server: \$schema=(\S+/(world|vehicle|study)\.schema\.json)", first)
        if not named or (path.parent / named[1]).resolve().parent != schema_dir.resolve():
            found.append(f"{path}: must start with "
                         "# yaml-language-server: $schema=../docs/reference/schema/world.schema.json")
            continue
        found += mistakes(validator_of(schema_dir, named[2]), path)
    print(f"{len(files)} files accepted" if not found else "\n".join(found))
    return not found


def refuse(schema_dir, folder):
    validator = validator_of(schema_dir, "world")
    missed, refused = [], 0
    for path in sorted(folder.glob("*.yaml")):
        expected = path.read_bytes().split(b"\n", 1)[0].decode()
        if not expected.startswith("# expect: ") or not any(re.search(each, expected) for each in EXPRESSIBLE):
            continue
        if path.stem in SKIPPED:
            print(f"skipped {path.name}: {SKIPPED[path.stem]}")
        elif list(mistakes(validator, path)):
            refused += 1
        else:
            missed.append(f"{path}: the schema accepts it; {expected[2:]}")
    print("\n".join([f"{refused} files refused"] + missed))
    # The folder was found, and the patterns still fit the messages.
    return not missed and refused >= 30


def main():
    if len(sys.argv) < 4 or sys.argv[2] not in ("accept", "refuse"):
        sys.exit(__doc__)
    schema_dir, paths = pathlib.Path(sys.argv[1]), [pathlib.Path(each) for each in sys.argv[3:]]
    good = accept(schema_dir, paths) if sys.argv[2] == "accept" else refuse(schema_dir, paths[0])
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
