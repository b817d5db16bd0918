# Luo & Zhao, example 2, the equations as restored: what the machine reading loses is put back, and what cannot be meant is corrected.
# Names are those of luo-zhao-example-2-symbolic.toml. The coordinates are x', y' in the paper, where the prime is no derivative, its phi is the
# angle of the frame and the constraint, and its u' is u here. doc/papers.md says of each difference whether it is a loss of the reading or
# an error of the text.

4.5: y' - x'*tan(theta) = 0

# Derivatives of (4.5)
dphi/dx': partial(derived.phi, x') = -tan(theta)
dphi/dy': partial(derived.phi, y') = 1
dphi/dtheta': partial(derived.phi, theta') = 0

# Generalized forces: active, reactive, of the angular acceleration, of the acceleration of the origin, centrifugal, of Coriolis
Q.x: Q.x = 0
Q.y: Q.y = 0
Q.theta: Q.theta = 0
QR.x: QR.x = -m'*u*cos(alpha + theta)
QR.y: QR.y = -m'*u*sin(alpha + theta)
QR.theta: QR.theta = -m'*u*b*sin(alpha)
Qomega.x: Qomega.x = omega'*y*(M + m) + omega'*sin(theta)*(a*M + b*m)
Qomega.y: Qomega.y = -omega'*x*(M + m) - omega'*cos(theta)*(a*M + b*m)
Qomega.theta: Qomega.theta = -omega'*(x*cos(theta) + y*sin(theta))*(a*M + b*m) - omega'*(J + a^2*M + b^2*m)
-dVO/dx: -partial(V_O, x) = -(vx'*cos(phi) + vy'*sin(phi))*(M + m)
-dVO/dy: -partial(V_O, y) = (vx'*sin(phi) - vy'*cos(phi))*(M + m)
-dVO/dtheta: -partial(V_O, theta) = (vx'*sin(theta + phi) - vy'*cos(theta + phi))*(a*M + b*m)
-dVomega/dx: -partial(V_omega, x) = omega^2*x*(M + m) + omega^2*cos(theta)*(a*M + b*m)
-dVomega/dy: -partial(V_omega, y) = omega^2*y*(M + m) + omega^2*sin(theta)*(a*M + b*m)
-dVomega/dtheta: -partial(V_omega, theta) = -omega^2*(x*sin(theta) - y*cos(theta))*(a*M + b*m)
Gamma.x: Gamma.x = 2*omega*y'*(M + m) + 2*omega*theta'*cos(theta)*(a*M + b*m)
Gamma.y: Gamma.y = -2*omega*x'*(M + m) + 2*omega*theta'*sin(theta)*(a*M + b*m)
Gamma.theta: Gamma.theta = -2*omega*(x'*cos(theta) + y'*sin(theta))*(a*M + b*m)

4.6: T_r = 1/2*M*((x' - a*theta'*sin(theta))^2 + (y' + a*theta'*cos(theta))^2) + 1/2*J*theta'^2
    + 1/2*m*((x' - b*theta'*sin(theta))^2 + (y' + b*theta'*cos(theta))^2)

# Frozen derivatives of (4.6)
D/Dt dT/dx': Dt(partial(T_r, x')) = (M + m)*x'' - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta))
D/Dt dT/dy': Dt(partial(T_r, y')) = (M + m)*y'' + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta))
D/Dt dT/dtheta': Dt(partial(T_r, theta')) = (J + a^2*M + b^2*m)*theta''
    + (a*M + b*m)*(y''*cos(theta) - x''*sin(theta) - y'*theta'*sin(theta) - x'*theta'*cos(theta))
dT/dx: partial(T_r, x) = 0
dT/dy: partial(T_r, y) = 0
dT/dtheta: partial(T_r, theta) = -theta'*(a*M + b*m)*(x'*cos(theta) + y'*sin(theta))

# Routh's equations
4.7: (M + m)*x'' - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta))
    = -m'*u*cos(alpha + theta) + (a*M + b*m)*(omega^2*cos(theta) + 2*omega*theta'*cos(theta) + omega'*sin(theta))
    + (M + m)*(omega'*y + 2*omega*y' + omega^2*x - vx'*cos(phi) - vy'*sin(phi)) - lambda*tan(theta)
4.8: (M + m)*y'' + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta))
    = -m'*u*sin(alpha + theta) + (a*M + b*m)*(omega^2*sin(theta) + 2*omega*theta'*sin(theta) - omega'*cos(theta))
    + (M + m)*(-omega'*x - 2*omega*x' + omega^2*y + vx'*sin(phi) - vy'*cos(phi)) + lambda
4.9: (J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y''*cos(theta) - x''*sin(theta))
    = -m'*u*b*sin(alpha) - (a*M + b*m)*(omega'*(x*cos(theta) + y*sin(theta))
    + 2*omega*(x'*cos(theta) + y'*sin(theta)) + omega^2*(x*sin(theta) - y*cos(theta)) - vx'*sin(theta + phi)
    + vy'*cos(theta + phi)) - (J + a^2*M + b^2*m)*omega'

# (4.7), (4.8) without the multiplier
4.10: (M + m)*(x''*cos(theta) + y''*sin(theta)) - (a*M + b*m)*(theta' + omega)^2
    = -m'*u*cos(alpha) + (M + m)*(omega'*(y*cos(theta) - x*sin(theta)) - 2*omega*(x'*sin(theta) - y'*cos(theta))
    + omega^2*(x*cos(theta) + y*sin(theta)) - vx'*cos(phi + theta) - vy'*sin(phi + theta))

# Generalized reactions
4.11: N.x = (M + m)*(x'' + vx'*cos(phi) + vy'*sin(phi) - omega'*y - 2*omega*y' - omega^2*x)
    - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta) + omega'*sin(theta) + omega^2*cos(theta)
    + 2*omega*theta'*cos(theta)) + m'*u*cos(alpha + theta)
4.12: N.y = (M + m)*(y'' - vx'*sin(phi) + vy'*cos(phi) + omega'*x + 2*omega*x' - omega^2*y)
    + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta) + omega'*cos(theta) - omega^2*sin(theta)
    - 2*omega*theta'*sin(theta)) + m'*u*sin(alpha + theta)
4.13: N.theta = 0
