# Luo & Zhao, example 1, the equations as restored: what the machine reading loses is put back, and what cannot be meant is corrected.
# Names are those of luo-zhao-example-1-symbolic.toml. The paper writes psi', phi' with dots, c psi and s psi for cos(psi) and sin(psi), and
# omega for w. doc/papers.md says of each difference whether it is a loss of the reading or an error of the text.

4.1: r'^2 + r^2*psi'^2 + r^2*cos(psi)^2*phi'^2 - c^2 = 0
4.2: T_r = 1/2*m*(r'^2 + r^2*psi'^2 + r^2*cos(psi)^2*phi'^2)

# Frozen derivatives of (4.2)
D/Dt dT/dr': Dt(partial(T_r, r')) = m*r''
D/Dt dT/dpsi': Dt(partial(T_r, psi')) = m*D(r^2*psi', 1)
D/Dt dT/dphi': Dt(partial(T_r, phi')) = m*D(r^2*cos(psi)^2*phi', 1)
dT/dr: partial(T_r, r) = m*r*(psi'^2 + cos(psi)^2*phi'^2)
dT/dpsi: partial(T_r, psi) = -m*r^2*phi'^2*sin(psi)*cos(psi)
dT/dphi: partial(T_r, phi) = 0

# Derivatives of (4.1)
df/dr': partial(derived.phi, r') = 2*r'
df/dpsi': partial(derived.phi, psi') = 2*r^2*psi'
df/dphi': partial(derived.phi, phi') = 2*r^2*phi'*cos(psi)^2

# Generalized forces: active, reactive, of the angular acceleration, of the acceleration of the origin and centrifugal, of Coriolis
Q.r: Q.r = -k^2/r^2*m
Q.psi: Q.psi = 0
Q.phi: Q.phi = 0
QR.r: QR.r = m'*ur
QR.psi: QR.psi = m'*r*up
QR.phi: QR.phi = m'*r*cos(psi)*uf
Qomega.r: Qomega.r = 0
Qomega.psi: Qomega.psi = 0
Qomega.phi: Qomega.phi = 0
-dV/dr: minus_dVO.r + minus_dVomega.r = m*w^2*r*cos(psi)^2
-dV/dpsi: minus_dVO.psi + minus_dVomega.psi = -m*w^2*r^2*sin(psi)*cos(psi)
-dV/dphi: minus_dVO.phi + minus_dVomega.phi = 0
Gamma.r: Gamma.r = 2*m*w*r*phi'*cos(psi)^2
Gamma.psi: Gamma.psi = -2*m*w*r^2*phi'*sin(psi)*cos(psi)
Gamma.phi: Gamma.phi = -2*m*w*r*cos(psi)*(r'*cos(psi) - r*psi'*sin(psi))

# Routh's equations
4.3.r: m*r'' - m*r*(psi'^2 + phi'^2*cos(psi)^2) = -k^2/r^2*m + m'*ur
    + 2*m*w*r*phi'*cos(psi)^2 + m*w^2*r*cos(psi)^2 + 2*r'*lambda
4.3.psi: m*D(r^2*psi', 1) + m*r^2*phi'^2*sin(psi)*cos(psi) = m'*r*up + 2*r^2*psi'*lambda
    - 2*m*w*r^2*phi'*sin(psi)*cos(psi) - m*r^2*w^2*sin(psi)*cos(psi)
4.3.phi: m*D(r^2*phi'*cos(psi)^2, 1) = m'*r*uf*cos(psi) + 2*m*w*r^2*psi'*sin(psi)*cos(psi)
    - 2*m*w*r*r'*cos(psi)^2 + 2*r^2*phi'*cos(psi)^2*lambda

# Generalized reactions
4.4.r: N.r = m*r'' - m*r*(psi'^2 + phi'^2*cos(psi)^2) + k^2/r^2*m - m'*ur
    - 2*m*w*r*phi'*cos(psi)^2 - m*w^2*r*cos(psi)^2
4.4.psi: N.psi = m*D(r^2*psi', 1) + m*r^2*phi'^2*sin(psi)*cos(psi) - m'*r*up
    + 2*m*w*r^2*phi'*sin(psi)*cos(psi) + m*r^2*w^2*sin(psi)*cos(psi)
4.4.phi: N.phi = m*D(r^2*phi'*cos(psi)^2, 1) - 2*m*w*r^2*psi'*sin(psi)*cos(psi)
    - m'*r*uf*cos(psi) + 2*m*w*r*r'*cos(psi)^2
