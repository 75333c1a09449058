# SPDX-License-Identifier: BSD-3-Clause
"""Robots of UberSim's self-instantiation XML as vehicles of Shoal."""
import math
import re
import xml.etree.ElementTree
from typing import NamedTuple

FORCE_NM = 50  # largest of a wheel's motor; the XML does not name it


class Robot(NamedTuple):
    entry: dict  # of `vehicles:`
    tilt_rad: float  # positive forward, at which it balances
    radius_m: float  # of its wheels


class Refused(ValueError):
    """What is wrong with the XML, in one sentence."""


def shown(element):
    return f'<{element.tag[:40]}>' + (f" '{element.get('name')[:40]}'" if element.get('name') else '')


def child(parent, tag):
    found = parent.findall(tag)
    if len(found) != 1:
        raise Refused(f'{shown(parent)} must have one <{tag}>, got {len(found)}')
    return found[0]


def number(parent, tag, low=-1e3):
    text = (child(parent, tag).text or '').strip()
    try:
        value = float(text.removesuffix('f'))  # the paper prints 1.5708f
    except ValueError:
        value = math.nan
    if not low <= value <= 1e3:
        raise Refused(f"{shown(parent)}: <{tag}> must be a number from {low:g} to 1000, got '{text[:40]}'")
    return value


def vector(parent, tag):
    """The paper has x to the right and y forward, Shoal x forward and y to the left."""
    x, y, z = (number(child(parent, tag), axis) for axis in 'xyz')
    return [y, 0 - x, z]


def name(element):
    found = element.get('name', '')
    if not re.fullmatch(r'[A-Za-z][A-Za-z0-9_]{0,30}', found):
        raise Refused(f"<{element.tag}> must have a name of 1 to 31 letters, digits and _, got '{found[:40]}'")
    return found


def rpy_deg(parent):
    """The turn of <Orientation>, which must be about one axis."""
    if parent.find('Orientation') is None:
        return [0, 0, 0]
    turn = child(parent, 'Orientation')
    axis = vector(turn, 'axis')
    if sorted(map(abs, axis)) != [0, 0, 1]:
        raise Refused(f'{shown(parent)}: <axis> must be one of x, y and z')
    return [0 + math.degrees(number(turn, 'angle')) * each for each in axis]


def part(element):
    made = {'name': name(element), 'mass_kg': number(element, 'Mass', 0), 'position_m': vector(element, 'Position'),
            'color': '#181818' if element.findtext('Material') == 'Rubber' else '#b0b0b8'}
    if element.tag == 'Box':
        return {**made, 'shape': 'box', 'size_m': [number(element, side + 'Size', 0) for side in 'YXZ']}
    if element.tag == 'Sphere':
        return {**made, 'shape': 'sphere', 'radius_m': number(element, 'Radius', 0)}
    # A wheel: the paper turns it about z, which does nothing to a cylinder along z; it is meant to lie along its axle.
    return {**made, 'shape': 'cylinder', 'radius_m': number(element, 'Radius', 0),
            'length_m': number(element, 'Length', 0), 'rpy_deg': [90, 0, 0]}


def device(element, body, width):
    made = {'name': name(element), 'body': body, 'phase_s': 0}
    if element.tag == 'Inclinometer':
        return {**made, 'type': 'inclinometer', 'ideal': True, 'rate_hz': 100}
    return {**made, 'type': 'camera', 'rate_hz': 20, 'width': width, 'height': width * 3 // 4,
            'fov_deg': number(element, 'Fov', 0), 'position_m': vector(element, 'Position'),
            'rpy_deg': rpy_deg(element)}


def joint(element):
    made = {'name': name(element), 'bodies': [(child(element, f'Body{i}').text or '').strip() for i in (1, 2)],
            'anchor_m': vector(element, 'AnchorPos')}
    if element.tag == 'JointBallSocket':
        return {**made, 'type': 'ball'}
    return {**made, 'type': 'hinge2', 'axis': vector(element, 'Axis1'),  # positive: forward
            'axis2': {'axis': [0 - each for each in vector(element, 'Axis2')]}}


def children(parent, *tags):
    for element in parent:
        if element.tag not in tags:
            raise Refused(f"{shown(parent)} cannot have a <{element.tag[:40]}>, only: {', '.join(tags)}")
        yield element


def read(path, width):
    """Reads a robot; its cameras have `width` pixels.  Raises Refused, and OSError for a file that cannot be read."""
    with open(path, encoding='utf-8', errors='replace') as file:
        text = file.read(1_000_001)
    if len(text) > 1_000_000 or '<!DOCTYPE' in text:
        raise Refused('the XML must have at most 1 MB and no <!DOCTYPE>')
    try:
        return robot_of(xml.etree.ElementTree.fromstring(text), width)
    except xml.etree.ElementTree.ParseError as error:
        raise Refused(f'no XML: {error}') from None


def robot_of(root, width):
    settings, entity = child(root, 'CSettings'), child(root, 'Entity')
    bodies, devices, joints = [], [], []
    solids = ('Box', 'Sphere', 'Cylinder')
    for body in children(child(entity, 'RigidBodyes'), 'Body'):  # spelled as printed
        parts = [part(each) for each in children(body, *solids, 'Inclinometer', 'CameraSensor') if each.tag in solids]
        bodies.append({'name': name(body), 'parts': parts})
        devices += [device(each, name(body), width) for each in body if each.tag not in solids]
    for each in children(child(entity, 'Joints'), 'JointHinge2', 'JointBallSocket'):
        joints.append(joint(each))
        if each.tag == 'JointHinge2':
            devices.append({'name': name(each), 'type': 'joint_drive', 'joint': name(each), 'axes': [1],
                            'max_velocity': 20, 'max_force': FORCE_NM})
    wheels = [each for body in bodies for each in body['parts'] if each['shape'] == 'cylinder']
    if not wheels:
        raise Refused('<Entity> must have a <Cylinder>, a wheel')
    x, y, z = vector(settings, 'Offset')
    height_m = max(each['radius_m'] - each['position_m'][2] for each in wheels)
    entry = {'name': (child(settings, 'Name').text or '').strip().lower(), 'with_client': True,
             'position_m': [x, y, z + height_m], 'rpy_deg': rpy_deg(settings),
             'model': {'shoal': 1, 'actuator_latency_s': number(settings, 'LatencyMS', 0) / 1000, 'bodies': bodies,
                       'joints': joints, 'devices': devices}}
    return Robot(entry, balanced_tilt_rad(bodies[0]['parts'], wheels[0]), wheels[0]['radius_m'])


def balanced_tilt_rad(parts, wheel):
    """The tilt at which the center of mass of the parts is above the axle."""
    mass_kg = sum(each['mass_kg'] for each in parts)
    if mass_kg == 0:
        raise Refused('the first <Body> must have a mass')
    x, z = (sum(each['mass_kg'] * each['position_m'][i] for each in parts) / mass_kg for i in (0, 2))
    return -math.atan2(x, z - wheel['position_m'][2])
