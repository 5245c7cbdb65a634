// The sensors that a robot of a world can have, and the ports that they and its motors go to.
//
// Owns the names that worlds have for them.

/** Ports, as far as a robot has them, with the variables that show them. */
export const PORTS = {
  A1: 'sensorA1',
  A2: 'sensorA2',
  A3: 'sensorA3',
  A4: 'sensorA4',
  A5: 'sensorA5',
  A6: 'sensorA6',
  D1: 'sensorD1',
  D2: 'sensorD2',
  LineSensorPort: 'lineSensor',
  ColorSensorPort: 'colorSensor',
  ObjectSensorXPort: 'objectSensorX',
  LidarPort: 'lidar',
};
export const sensorPort = (name: keyof typeof PORTS): string => `${name}###input######${PORTS[name]}`;
/** Motors, as wheels name them. */
export const MOTORS = ['M1', 'M2', 'M3', 'M4'].map((name) => `${name}###output######${name}`);

const PARTS = 'trik::robotModel::parts::';
const ANALOG = ['A1', 'A2', 'A3', 'A4', 'A5', 'A6'] as const;
/** Types of sensors, and the ports that each goes to. */
export const SENSORS: readonly { type: string; ports: readonly (keyof typeof PORTS)[] }[] = [
  { type: `${PARTS}TrikInfraredSensor`, ports: ANALOG },
  { type: `${PARTS}TrikSonarSensor`, ports: ['D1', 'D2'] },
  { type: `${PARTS}TrikLightSensor`, ports: ANALOG },
  { type: `${PARTS}TrikTouchSensor`, ports: ANALOG },
  { type: `${PARTS}TrikLineSensor`, ports: ['LineSensorPort'] },
  { type: `${PARTS}TrikColorSensor`, ports: ['ColorSensorPort'] },
  { type: `${PARTS}TrikObjectSensor`, ports: ['ObjectSensorXPort'] },
  { type: 'kitBase::robotModel::robotParts::LidarSensor', ports: ['LidarPort'] },
];
