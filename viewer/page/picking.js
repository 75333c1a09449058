// SPDX-License-Identifier: BSD-3-Clause
// The mouse in the scene: a click selects the vehicle under it, or sets an end of the measuring tape.
import {Plane, Raycaster, Vector2, Vector3} from './vendor/three.js';

/** A press that moves further than this is a drag. */
const CLICK_PX = 5;
/** A click this close to the middle of a vehicle selects it too: vehicles far away are small. */
const NEAR_PX = 22;

/** Picks vehicles and points; owner(body) gives the name of the vehicle of a body, or null. */
export class Picking {
  constructor(element, view) {
    this.element = element;
    this.view = view;
    this.ray = new Raycaster();
    this.measuring = false;
    this.points = [];
    let down = null;
    element.addEventListener('pointerdown', (event) => {
      down = [event.clientX, event.clientY];
    });
    element.addEventListener('pointerup', (event) => {
      const still = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < CLICK_PX;
      down = null;
      if (still && event.button === 0) this.click(event.clientX, event.clientY);
    });
    element.addEventListener('dblclick', (event) => {
      const name = this.vehicleAt(event.clientX, event.clientY);
      if (name !== null) view.follow(name);
    });
  }

  click(x, y) {
    if (!this.measuring) {
      const name = this.vehicleAt(x, y);
      if (name !== null) this.view.select(name);
      return;
    }
    const point = this.pointAt(x, y);
    if (!point) return;
    if (this.points.length >= 2) this.points = [];
    this.points.push(point);
  }

  aim(x, y) {
    const part = this.view.sides.regionAt(x, y);
    const at = new Vector2(2 * (x - part.x) / part.width - 1, 1 - 2 * (y - part.y) / part.height);
    this.ray.setFromCamera(at, this.view.camera);
    const hits = () => this.ray.intersectObjects(this.view.bodies.pickable, false);
    return part.other ? this.view.sides.withOther(hits) : hits();
  }

  /** Name of the vehicle at a position of the page; null: none. */
  vehicleAt(x, y) {
    const hit = this.aim(x, y)[0];
    const name = hit ? this.view.owner(hit.object.userData.bodies[hit.instanceId ?? 0]) : null;
    if (name !== null) return name;
    // The nearest vehicle on the screen.
    let nearest = null, least_px = NEAR_PX;
    const {sides} = this.view;
    for (const vehicle of sides.regionAt(x, y).other ? sides.others : this.view.vehicles) {
      const at = sides.pixelOf(vehicle, x, y);
      const off_px = at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
      if (off_px < least_px) [nearest, least_px] = [vehicle.name, off_px];
    }
    return nearest;
  }

  /** Point of a surface, or of the level z = 0 or of the water. */
  pointAt(x, y) {
    const hit = this.aim(x, y)[0];
    if (hit) return hit.point;
    return this.ray.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -this.view.level()), new Vector3());
  }

  /** Starts or ends measuring. */
  setMeasuring(on) {
    this.measuring = on;
    this.points = [];
    this.element.style.cursor = on ? 'crosshair' : '';
  }

  /** Text of the tape: distance, and its parts along and across. */
  text() {
    if (this.points.length < 2) return '';
    const [a, b] = this.points;
    const flat_m = Math.hypot(b.x - a.x, b.y - a.y);
    return `${a.distanceTo(b).toFixed(2)} m (level ${flat_m.toFixed(2)}, up ${(b.z - a.z).toFixed(2)})`;
  }
}
