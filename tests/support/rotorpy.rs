//! RotorPy's vehicle as ours: the mapping of its parameters.
//!
//! ```text
//! RotorPy 3.0 (compute_body_wrench)                       ours, with Omega_h the hover speed of N rotors
//! T_i = k_eta Omega_i^2, yaw dir_i k_m Omega_i^2          thrust coefficient k_eta, torque per thrust k_m / k_eta
//! H_i = -Omega_i diag(k_d, k_d, k_z) v_i at each hub      linear_drag dx = dy = N k_d Omega_h; inflow kz = N k_z Omega_h
//! M_i = -k_flap Omega_i (v_i x e_z)                       blade_flapping k = N k_flap Omega_h
//! T_i += k_h (v_x^2 + v_y^2)                              translational_lift kh = N k_h
//! D = -|v_a| diag(c_D) v_a                                quadratic_drag cx, cy, cz
//! Omega' = (Omega_c - Omega) / tau_m                      motor_lag time_constant
//! ```
//!
//! Its hub positions are from the centre of mass, its body and world frames are ours, its quaternion is
//! i j k w, and its rotor directions are the signs of the reaction torque.

use mavid::physics::effects::{
    BladeFlapping, Inflow, LinearDrag, MotorLag, QuadraticDrag, TranslationalLift,
};
use mavid::physics::{ActiveEffect, Model};
use mavid::vehicle::{Actuator, Anchor, Limits, Propulsion, RigidBody, Rotor, Spin, ThrustLaw, Vehicle};
use nalgebra::{Matrix3, Vector3};
use serde_json::{Value, json};

/// RotorPy's parameters of an AscTec Hummingbird, with products of inertia, offset hubs and flapping, so
/// that every term shows.
pub struct Hummingbird {
    pub k_eta: f64,
    pub k_m: f64,
    pub k_d: f64,
    pub k_z: f64,
    pub k_h: f64,
    pub k_flap: f64,
    pub c_d: [f64; 3],
    pub tau_m_s: f64,
    pub mass_kg: f64,
    /// xx yy zz xy xz yz
    pub inertia_kg_m2: [f64; 6],
    pub hubs_m: [[f64; 3]; 4],
    pub speed_max_rad_s: f64,
}

pub const HUMMINGBIRD: Hummingbird = Hummingbird {
    k_eta: 5.57e-6,
    k_m: 1.36e-7,
    k_d: 1.19e-4,
    k_z: 2.32e-4,
    k_h: 3.39e-3,
    k_flap: 2.1e-5,
    c_d: [0.5e-2, 0.7e-2, 1e-2],
    tau_m_s: 0.02,
    mass_kg: 0.5,
    inertia_kg_m2: [3.65e-3, 3.68e-3, 7.03e-3, 4e-5, -7e-5, 3e-5],
    hubs_m: [[0.12, 0.12, 0.01], [0.12, -0.12, 0.01], [-0.12, -0.12, 0.012], [-0.12, 0.12, 0.008]],
    speed_max_rad_s: 1500.0,
};

const YAW_SIGNS: [f64; 4] = [1.0, -1.0, 1.0, -1.0];
const GRAVITY_M_S2: f64 = 9.81;

impl Hummingbird {
    /// rad/s
    pub fn hover_rad_s(&self) -> f64 {
        (self.mass_kg * GRAVITY_M_S2 / 4.0 / self.k_eta).sqrt()
    }

    /// In RotorPy's words.
    pub fn params(&self) -> Value {
        let [xx, yy, zz, xy, xz, yz] = self.inertia_kg_m2;
        json!({
            "mass": self.mass_kg, "Ixx": xx, "Iyy": yy, "Izz": zz, "Ixy": xy, "Ixz": xz, "Iyz": yz,
            "num_rotors": 4, "rotor_pos": self.hubs_m, "rotor_directions": YAW_SIGNS,
            "c_Dx": self.c_d[0], "c_Dy": self.c_d[1], "c_Dz": self.c_d[2],
            "k_eta": self.k_eta, "k_m": self.k_m, "k_d": self.k_d, "k_z": self.k_z, "k_h": self.k_h,
            "k_flap": self.k_flap, "tau_m": self.tau_m_s, "motor_noise_std": 0.0,
            "rotor_speed_min": 0.0, "rotor_speed_max": self.speed_max_rad_s,
        })
    }

    /// In ours.
    pub fn model(&self) -> Model {
        let [xx, yy, zz, xy, xz, yz] = self.inertia_kg_m2;
        let rotors = self.hubs_m.iter().zip(YAW_SIGNS).map(|(hub, sign)| Rotor {
            name: String::new(),
            position_m: Vector3::from(*hub),
            spin: if sign > 0.0 { Spin::Cw } else { Spin::Ccw },
        });
        let vehicle = Vehicle {
            name: "hummingbird".into(),
            body: RigidBody {
                mass_kg: self.mass_kg,
                inertia_kg_m2: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
                center_of_mass_m: Vector3::zeros(),
                gyroscopic: 1.0,
            },
            propulsion: Propulsion {
                actuator: Actuator::Speed,
                law: ThrustLaw::Speed { speed_max_rad_s: self.speed_max_rad_s },
                thrust_coefficient: Some(self.k_eta),
                torque_per_thrust_m: self.k_m / self.k_eta,
                rotor_radius_m: Some(0.1),
                time_constant_s: None,
                time_constant_down_s: None,
            },
            rotors: rotors.collect(),
            limits: Limits::default(),
            anchor: Anchor::Thrust,
            guesses: Vec::new(),
            gravity_m_s2: GRAVITY_M_S2,
        };
        let at_hover = 4.0 * self.hover_rad_s();
        let effects = [
            ActiveEffect::new(&LinearDrag, &[self.k_d * at_hover, self.k_d * at_hover, 0.0]),
            ActiveEffect::new(&Inflow, &[self.k_z * at_hover]),
            ActiveEffect::new(&BladeFlapping, &[self.k_flap * at_hover]),
            ActiveEffect::new(&TranslationalLift, &[4.0 * self.k_h]),
            ActiveEffect::new(&QuadraticDrag, &self.c_d),
            ActiveEffect::new(&MotorLag, &[self.tau_m_s]),
        ];
        Model::new(&vehicle, effects.into_iter().collect::<Result<_, _>>().unwrap()).unwrap()
    }
}
