# The accelerations that the author of the thread gives as the right ones.
yaw:  q1'' = -2*q2'*q3'/cos(q2)
lean: q2'' = 4*g*sin(q2)/(5*r) + sin(2*q2)*q1'^2/2 + 6*cos(q2)*q1'*q3'/5
roll: q3'' = -(10*cos(q2)*q1' - 12*tan(q2)*q3')*q2'/6
